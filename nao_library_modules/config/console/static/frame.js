// What every page has: the stop, on a line of its own that is open already and by a request as well, what comes first
// counts; and the console's pulse, by which a page knows whether what it shows is true. See console/app.py.

import { arrived, doubt, pressOf, refuse, sending, tell as tellUnsent } from "./presses.js";

const PATH = "/console/stop";
const AGAIN = 700; // ms until a line that broke is opened again
const SILENT = 1400; // ms without a beat, after which the console does not answer
const LOOK = 200; // ms between two looks
const PATIENCE = 5000; // ms until a line that does not open is given up for a new one
const PAGE_PATIENCE = 10000, PAGE_AGAIN = 1000; // ms, the same for the page's own connection, and the longest pause
const LATE = 3000; // ms that a press may wait for the first connection of its page
const BEATS = 60; // of which the console's clock is known
const OPEN = ".q-dialog__inner, .q-menu"; // what Escape closes
const STATES = { stopping: "Stopping…", stopped: "Stopped" };
const WAY_OUT = "Press the robot's chest button twice, or run “nao stop”.";
const TROUBLE = {
  gone: `The console does not answer. What this page shows may be old, and Stop does not reach it. ${WAY_OUT}`,
  hung: "This page has lost its console: what it shows may be old, and only Stop works.",
  out: `You are logged out, and Stop does not reach the console: log in again. ${WAY_OUT}`,
};

const header = () => document.querySelector(".nao-header");
const robotShown = () => header()?.dataset.robot ?? "";
const waiting = new Map(); // id of a stop -> what takes its answer
const offsets = []; // s from this page's clock to the console's, as the last beats told
let line = null;
let begun = 0; // ms, when the line was begun
let beat = null; // the last one
let heard = performance.now(); // ms, when it came
let looked = performance.now(); // ms, the last look
let lost = false; // whether the page has no connection of its own, which it had
let state = ""; // of the console: a key of TROUBLE, or empty
let owed = null; // id of a stop that did not reach the console
let sent = false; // whether a stop is on its way
let loggedOut = false;
const early = []; // when something was pressed before the page was connected: NiceGUI keeps that until it is

function tell(message, type) {
  window.Quasar?.Notify?.create({ message, type });
}

// --- the pulse

// What is wrong with the console: a key of TROUBLE, or empty.
export function trouble() {
  return state;
}

// Now, by the console's clock, in s; undefined before it is known.
export function consoleTime() {
  return offsets.length ? performance.now() / 1000 + Math.max(...offsets) : undefined;
}

function take(message) {
  if (beat && message.console !== beat.console) {
    location.reload(); // another console: this one's page is not known there
    return;
  }
  beat = message;
  heard = performance.now();
  loggedOut = false;
  arrived();
  offsets.push(message.beat - heard / 1000);
  if (offsets.length > BEATS) offsets.shift();
  show();
}

function troubleNow() {
  if (loggedOut) return "out";
  if (performance.now() - heard > (beat ? SILENT : PATIENCE)) return "gone";
  return beat && (!beat.pages || lost) ? "hung" : "";
}

function show() {
  const before = state;
  state = troubleNow();
  document.body.dataset.console = state;
  if (state && !before) {
    doubt();
    window.dispatchEvent(new CustomEvent("nao-console-lost"));
    if (state === "gone") reconnectPage();
  }
  if (before && !state) window.dispatchEvent(new CustomEvent("nao-console-back"));
  setText(".nao-told", TROUBLE[state] ?? "");
  const reaches = state !== "gone" && state !== "out";
  setText(".nao-stop-state", !reaches ? "No connection" : sent ? "Sent…" : STATES[beat?.state] ?? "");
  const button = document.querySelector(".nao-stop");
  if (button) button.dataset.state = reaches ? beat?.state ?? "" : "";
}

function setText(css, text) {
  const found = document.querySelector(css);
  if (found && found.textContent !== text) found.textContent = text;
}

// The page's own connection is taken anew: what waits in it would come late.
function reconnectPage() {
  if (window.socket?.connected) window.socket.io.engine.close();
}

// As NiceGUI comes back, but for a console that does not answer: it loads the page again then, and nothing is left of it.
function keepPage(socket) {
  socket.off("connect_error");
  socket.on("connect_error", (error) => error.message === "Implicit handshake failed" && location.reload());
  socket.io.timeout(PAGE_PATIENCE);
  socket.io.reconnectionDelayMax(PAGE_AGAIN);
}

// A press is for the moment in which it is made: it is refused while the console does not answer, and has a stamp else.
// Values of fields are let through: page and console agree on them then.
function guardPresses(socket) {
  const { emit } = socket;
  socket.emit = function (name, message, ...rest) {
    if (name !== "event" || isValue(message)) return emit.call(socket, name, message, ...rest);
    const press = pressOf(message);
    const waited = press && early.length ? performance.now() - early.shift() : 0;
    if (socket.connected && !state && waited < LATE) {
      const at = consoleTime() - waited / 1000; // NaN, and no stamp then, before the console's clock is known
      const press_id = press && !press.silent ? sending({ label: press.label, via: press.via }) : undefined;
      return emit.call(socket, name, { ...message, label: press?.label, at, press_id }, ...rest);
    }
    const { silent, ...refused } = press ?? { silent: true };
    if (!silent) refuse(refused);
    return socket;
  };
  socket.on("connect", () => {
    setTimeout(() => early.splice(0), LATE); // what NiceGUI has kept is given to emit by then
    tellUnsent();
  });
}

function isValue(message) {
  const events = mounted_app.elements[message.id]?.events ?? []; // of nicegui.js
  return events.some((each) => each.listener_id === message.listener_id && each.type.startsWith("update:"));
}

function look() {
  const now = performance.now();
  heard += Math.max(now - looked - 2 * LOOK, 0); // this page was held up itself, and what came meanwhile comes now
  looked = now;
  if (window.socket && !window.socket.kept) {
    window.socket.kept = true; // NiceGUI has set its own listeners by now
    keepPage(window.socket);
  }
  lost = Boolean(window.did_handshake && !window.socket.connected);
  show();
  if (!line && !begun && header()) {
    connect();
    new ResizeObserver(measure).observe(header());
  }
  const slow = line?.readyState === WebSocket.OPEN || now - begun > PATIENCE;
  if (state === "gone" && line && slow) connect(); // its end would be told late, as its messages are
}

function measure() {
  document.documentElement.style.setProperty("--nao-bar", `${header().offsetHeight}px`);
}

function connect() {
  const former = line;
  const query = new URLSearchParams({ robot: robotShown() });
  const made = new WebSocket(`${location.origin.replace(/^http/, "ws")}${PATH}?${query}`);
  line = made;
  begun = performance.now();
  former?.close();
  made.addEventListener("open", () => {
    if (made === line && owed !== null) stop(owed); // late, but never lost
  });
  made.addEventListener("message", (event) => {
    const message = JSON.parse(event.data);
    if (message.beat === undefined) waiting.get(message.id)?.(message);
    else if (made === line) take(message);
  });
  made.addEventListener("close", async () => {
    if (made !== line) return;
    line = null;
    setTimeout(() => line ?? connect(), AGAIN);
    // A WebSocket does not say why it is not let in; a request does.
    const answer = await fetch(import.meta.url, { method: "HEAD", cache: "no-store" }).catch(() => null);
    loggedOut = answer?.status === 401;
    show();
  });
}

// --- the stop

function byLine(robot, id) {
  return new Promise((resolve, reject) => {
    if (line?.readyState !== WebSocket.OPEN) throw new Error("the line is not open");
    waiting.set(id, resolve);
    line.addEventListener("close", reject, { once: true });
    line.send(JSON.stringify({ robot, id }));
  });
}

async function byRequest(robot, id) {
  const query = new URLSearchParams({ robot, id });
  return (await fetch(`${PATH}?${query}`, { method: "POST", keepalive: true })).json();
}

async function stop(id = `${Date.now()}-${Math.random()}`) {
  window.dispatchEvent(new CustomEvent("nao-stop")); // whatever else the page holds
  const robot = robotShown();
  owed = id;
  sent = true;
  show();
  try {
    const answer = await Promise.any([byLine(robot, id), byRequest(robot, id)]);
    owed = null;
    if (answer.error) tell(answer.error, "negative");
    else if (beat) beat = { ...beat, state: answer.state };
  } catch {
    tell("Stop did not reach the console. It is sent as soon as the console answers.", "negative");
  } finally {
    sent = false;
    waiting.delete(id);
    show();
  }
}

// What is open, the last one first; not what is closing already.
function opened() {
  return [...document.querySelectorAll(OPEN)].filter((each) => !each.closest("[class*=leave-active]")).pop();
}

// A dialog that does not close by Escape has a button for it: Escape goes there, and then presses it.
function leave(dialog) {
  const button = dialog.querySelector(".nao-close");
  if (!button) return;
  if (document.activeElement === button) button.click();
  else button.focus();
}

// NiceGUI makes its socket behind this script.
let made = null;
Object.defineProperty(window, "socket", {
  get: () => made,
  set: (socket) => {
    made = socket;
    if (socket) guardPresses(socket);
  },
});
for (const type of ["click", "keydown"]) {
  window.addEventListener(type, () => window.did_handshake || early.push(performance.now()), { capture: true });
}
look();
setInterval(look, LOOK);
window.addEventListener(
  "keydown",
  (event) => {
    if (event.key !== "Escape" || event.repeat) return;
    const over = opened();
    if (over) leave(over);
    else stop();
  },
  { capture: true },
);
window.addEventListener("click", (event) => event.target.closest?.(".nao-stop") && stop(), { capture: true });
