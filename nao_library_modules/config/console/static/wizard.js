// The wizard's page: <nao-wizard-buttons>, <nao-wizard-drive>, keys, gamepad and pointing on <nao-camera>.
// All of it goes over one WebSocket a page, /console/drive; console/wizard/desk.py tells the messages.

import { consoleTime, trouble } from "./frame.js";
import { refuse, sending } from "./presses.js";

const PERIOD = 100; // ms between two velocities while one is held
const DEAD_ZONE = 0.15; // of a gamepad's sticks
const DEAD_MAN = [4, 5, 6, 7]; // shoulder buttons of a gamepad: one is held while it walks
const FIRST_RETRY = 300, LONGEST_RETRY = 5000; // ms
const NOTICE_PERIOD = 1500; // ms until the same notice is shown again
const NOTICE_SHOWN = 8000; // ms
const FIELDS = "input:not([type=range]):not([type=checkbox]):not([type=radio]):not([type=button]), textarea, select, " +
  "[contenteditable]:not([contenteditable=false]), [role=combobox], [role=textbox], [role=listbox]";
const ARROW_TAKERS = "[role=slider], [role=radio], [role=tab], [role=menu], [role=menuitem], input";

const CSS = `
nao-wizard-buttons, nao-wizard-drive { display: block; width: 100%; color: inherit; }
nao-wizard-buttons section { margin: 0 0 14px; }
nao-wizard-buttons h2 { font: 600 15px/1.3 inherit; font-size: 15px; line-height: 1.3; font-weight: 600; margin: 0 0 6px; }
nao-wizard-buttons ul { list-style: none; margin: 0; padding: 0; display: grid; gap: 8px;
  grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); }
nao-wizard-buttons button { width: 100%; min-height: 52px; padding: 6px 10px; border-radius: 6px; cursor: pointer;
  border: 1px solid rgba(127, 127, 127, 0.6); font: inherit; display: flex; align-items: center; gap: 8px;
  justify-content: space-between; text-align: left; background: #eceff1; color: #000; }
body.body--dark nao-wizard-buttons button { background: #37474f; color: #fff; }
nao-wizard-buttons button:focus-visible, nao-wizard-drive :focus-visible { outline: 3px solid #1976d2;
  outline-offset: 2px; }
body.body--dark nao-wizard-buttons button:focus-visible, body.body--dark nao-wizard-drive :focus-visible {
  outline-color: #90caf9; }
nao-wizard-buttons button:active { transform: translateY(1px); }
nao-wizard-buttons button[data-state=runs], nao-wizard-buttons button[data-state=repeats] {
  box-shadow: 0 0 0 3px #f9a825; }
nao-wizard-buttons button[aria-disabled=true] { cursor: not-allowed; border-style: dashed; filter: saturate(0.3); }
nao-wizard-buttons button[data-failed] { border: 4px dashed #b3261e; outline: 2px solid #fff; }
nao-wizard-buttons button[data-failed] .state { font-weight: 700; }
nao-wizard-buttons button[data-failed] .state::before { content: "\\26A0\\FE0E  "; }
nao-wizard-buttons .label { overflow-wrap: anywhere; }
nao-wizard-buttons .state { display: block; font-size: 12px; }
nao-wizard-buttons .state:empty { display: none; }
nao-wizard-buttons kbd, nao-wizard-drive kbd { font: 600 12px monospace; padding: 2px 6px; border-radius: 4px;
  border: 1px solid currentColor; white-space: nowrap; }
nao-wizard-buttons p { margin: 0; }
nao-wizard-buttons .told { min-height: 1.5em; }
nao-wizard-buttons .notice { position: fixed; inset: auto 0 0 50%; height: var(--nao-strip); z-index: 2100;
  overflow-y: auto; background: #fff3cd; color: #000; padding: 8px 12px; border: 2px solid #b26a00; }
nao-wizard-buttons .notice:empty { display: none; }
nao-wizard-drive .pads { display: flex; gap: 16px; align-items: center; flex-wrap: wrap; }
nao-wizard-drive .pad { position: relative; touch-action: none; background: rgba(127, 127, 127, 0.18);
  border: 2px solid rgba(127, 127, 127, 0.8); cursor: grab; user-select: none; -webkit-user-select: none; }
nao-wizard-drive .pad.round { width: 148px; height: 148px; border-radius: 50%; }
nao-wizard-drive .pad.flat { width: 148px; height: 48px; border-radius: 24px; }
nao-wizard-drive .knob { position: absolute; width: 44px; height: 44px; left: 50%; top: 50%; margin: -22px 0 0 -22px;
  border-radius: 50%; background: #1976d2; border: 2px solid #fff; pointer-events: none; }
nao-wizard-drive .pad.held { cursor: grabbing; border-color: #f9a825; }
nao-wizard-drive label { display: flex; gap: 8px; align-items: center; margin: 6px 0; }
nao-wizard-drive input[type=range] { flex: 1; min-width: 100px; accent-color: #1976d2; }
nao-wizard-drive input[type=checkbox] { width: 18px; height: 18px; accent-color: #1976d2; }
nao-wizard-drive .told { min-height: 1.4em; margin: 4px 0 0; font-size: 13px; }
nao-wizard-drive .told.walks { font-weight: 600; }
nao-wizard-drive .help { font-size: 13px; margin: 6px 0 0; }
`;

function addStyle() {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(CSS);
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
}

function make(name, properties = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key === "text") element.textContent = value;
    else if (key === "class") element.className = value;
    else element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
}

function element(event) {
  const first = event.composedPath()[0];
  return first instanceof Element ? first : document.body;
}

// Whether what is typed goes into a text field; inside of a shadow root as well.
function types(target) {
  return target.closest(FIELDS) !== null;
}

// A key in the form of the wizard's file: "H", "Shift+H", "1", "F2", "ArrowUp".
export function keyName(event) {
  const digit = /^(?:Digit|Numpad)(\d)$/.exec(event.code || "");
  let name = event.key;
  if (digit && (event.code.startsWith("Digit") || /^\d$/.test(event.key))) name = digit[1];
  else if (name.length === 1) name = name.toUpperCase();
  return event.shiftKey && /^[A-Z0-9]$/.test(name) ? `Shift+${name}` : name;
}

// The sum of velocities, each part within -1..1.
export function sum(velocities) {
  const total = [0, 0, 0];
  for (const velocity of velocities) velocity.forEach((part, i) => (total[i] += part));
  return total.map((part) => Math.min(Math.max(part, -1), 1));
}

// What a gamepad asks for: left stick walks, right stick turns, while a shoulder button is held.
export function gamepadVelocity(pad) {
  const held = DEAD_MAN.some((i) => pad.buttons[i] && pad.buttons[i].pressed);
  if (!held) return [0, 0, 0];
  const axis = (i) => {
    const value = pad.axes[i] || 0;
    const beyond = Math.max(Math.abs(value) - DEAD_ZONE, 0) / (1 - DEAD_ZONE);
    return value < 0 ? beyond : -beyond;
  };
  return [axis(1), axis(0), axis(2)].map((part) => part || 0);
}

// One page's WebSocket, what is held, and the keys.
class WizardLink extends EventTarget {
  static of(robot) {
    if (!links.has(robot)) links.set(robot, new WizardLink(robot));
    const link = links.get(robot);
    link.users += 1;
    return link;
  }

  constructor(robot) {
    super();
    this.robot = robot;
    this.users = 0;
    this.layout = null;
    this.states = {};
    this.words = {}; // what stands on a button in a state, told by the server, and which states have failed
    this.failed = [];
    this.unsent = new Set(); // ids of buttons of which the server does not know that they were pressed
    this.walking = {}; // key -> velocity, told by the server
    this.sources = { keys: [0, 0, 0], joystick: [0, 0, 0], gamepad: [0, 0, 0] };
    this.held = new Set();
    this.speed = null;
    this.keysOn = true;
    this.retry = FIRST_RETRY;
    this.noticed = { text: "", time: -Infinity }; // the last one that was shown
    this.gamepadFree = false; // whether it was let go since the last stop
    this.ends = new AbortController();
    const until = { signal: this.ends.signal };
    window.addEventListener("keydown", (event) => this.down(event), until);
    window.addEventListener("keyup", (event) => this.up(event), { ...until, capture: true });
    window.addEventListener("nao-stop", () => this.stopOthers(), until);
    window.addEventListener("nao-console-lost", () => this.socket.close(), until);
    window.addEventListener("nao-console-back", () => this.openNow(), until);
    window.addEventListener("blur", () => this.letGo(), until);
    window.addEventListener("pagehide", () => this.letGo(), until);
    document.addEventListener("visibilitychange", () => document.hidden && this.letGo(), until);
    document.addEventListener("focusin", (event) => types(element(event)) && this.letGo(), until);
    document.addEventListener("nao-point", (event) => this.point(event), until);
    window.addEventListener("gamepadconnected", () => this.watchGamepad(), until);
    window.addEventListener("gamepaddisconnected", () => this.source("gamepad", [0, 0, 0]), until);
    this.open();
    if (this.gamepads().length) this.watchGamepad();
  }

  release() {
    this.users -= 1;
    if (this.users > 0) return;
    this.letGo();
    this.closed = true;
    this.ends.abort();
    clearTimeout(this.timer);
    this.socket.close();
    links.delete(this.robot);
  }

  open() {
    const address = new URL("/console/drive", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    address.searchParams.set("robot", this.robot);
    const socket = new WebSocket(address);
    socket.onopen = () => {
      this.retry = FIRST_RETRY;
      this.unsent.clear();
      this.tell("connection", { open: true });
    };
    socket.onmessage = (event) => this.receive(JSON.parse(event.data));
    socket.onclose = (event) => {
      if (this.closed) return;
      this.letGo();
      this.tell("connection", { open: false, reason: event.reason });
      this.timer = setTimeout(() => this.open(), this.retry);
      this.retry = Math.min(2 * this.retry, LONGEST_RETRY);
    };
    this.socket = socket;
  }

  openNow() {
    if (this.socket.readyState !== WebSocket.CLOSED) return;
    clearTimeout(this.timer);
    this.retry = FIRST_RETRY;
    this.open();
  }

  get connected() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  // `ends`: it stops something, and is sent whatever the page knows of the console.
  // `message`: or a function that makes it, where it is sent.
  send(message, ends = message.stop || message.walk?.every((part) => part === 0)) {
    if (!this.connected || (trouble() && !ends)) return false;
    this.socket.send(JSON.stringify({ ...(message instanceof Function ? message() : message), at: consoleTime() }));
    return true;
  }

  receive(message) {
    if (message.layout) {
      this.layout = message.layout;
      this.words = message.words;
      this.failed = message.failed;
      this.notSent = message.not_sent;
      this.walking = message.walking;
      if (this.speed === null) this.speed = message.layout.speed;
      this.tell("layout", {});
    }
    if (message.states) {
      this.states = message.states;
      this.unsent.clear();
      this.tell("states", {});
    }
    if (message.let_go) this.letGo(); // somebody has stopped the robot
    if (message.notice) this.notice(message.notice);
  }

  tell(kind, detail) {
    this.dispatchEvent(new CustomEvent(kind, { detail }));
  }

  // What went wrong, in words; a velocity that is refused ten times a second is told once.
  notice(text) {
    const now = performance.now();
    if (text === this.noticed.text && now - this.noticed.time < NOTICE_PERIOD) return;
    this.noticed = { text, time: now };
    this.tell("notice", { text });
  }

  // --- buttons and keys

  press(id, via) {
    const button = this.layout.groups.flatMap((group) => group.buttons).find((each) => each.id === id);
    const group = this.layout.groups.find((each) => each.buttons.includes(button)).title;
    const press = { label: button.label, group, via };
    const of = button.robot;
    const made = () => ({ ...press, press: id, press_id: sending({ ...press, of }), revision: this.layout.revision });
    if (this.send(made, button.stops)) return;
    refuse({ ...press, of });
    this.unsent.add(id);
    this.tell("states", {});
  }

  // The frame stops the robot of the page; this ends what is held, and the other robots.
  stopOthers() {
    this.letGo();
    this.send({ stop: true });
  }

  down(event) {
    if (event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey || event.isComposing) return;
    const target = element(event);
    if (!this.keysOn || !this.layout || types(target) || document.querySelector(".q-dialog")) return;
    const name = keyName(event);
    if (name in this.walking) {
      if (name.startsWith("Arrow") && target.closest(ARROW_TAKERS)) return;
      event.preventDefault();
      if (!event.repeat) {
        this.held.add(name);
        this.walkByKeys();
      }
      return;
    }
    const id = this.layout.keys[name];
    if (id === undefined) return;
    event.preventDefault();
    if (!event.repeat) this.press(id, "key");
  }

  up(event) {
    const name = keyName(event).replace("Shift+", "");
    if (this.held.delete(name)) this.walkByKeys();
  }

  walkByKeys() {
    this.source("keys", sum([...this.held].map((name) => this.walking[name])));
  }

  // --- walking

  // Every velocity is told at once, and ten times a second while one is held.
  source(name, velocity) {
    this.sources[name] = velocity;
    const moves = sum(Object.values(this.sources)).some((part) => part !== 0);
    if (moves && !this.clock) this.clock = setInterval(() => this.walk(), PERIOD);
    if (!moves && this.clock) {
      clearInterval(this.clock);
      this.clock = null;
    } else if (!moves) {
      return;
    }
    this.walk();
  }

  walk() {
    const velocity = sum(Object.values(this.sources)).map((part) => Number((part * this.speed).toFixed(3)));
    const moves = velocity.some((part) => part !== 0);
    if (!this.send({ walk: velocity }) && moves) this.notice("no connection to the console: the robot does not walk");
    this.tell("walk", { velocity });
  }

  // Ends what is held. Keys and joysticks begin again with a new press; a gamepad once it was let go.
  letGo() {
    this.held.clear();
    this.gamepadFree = false;
    this.tell("release", {});
    this.sources.joystick = this.sources.gamepad = [0, 0, 0];
    this.source("keys", [0, 0, 0]);
  }

  gamepads() {
    return (navigator.getGamepads ? [...navigator.getGamepads()] : []).filter((pad) => pad && pad.connected);
  }

  // Looks at gamepads while there are any and the page is seen; without pictures to draw there is no look, and it stops.
  watchGamepad() {
    if (this.watching || this.closed) return;
    this.watching = true;
    const look = () => {
      const pads = this.gamepads();
      if (this.closed || !pads.length) {
        this.watching = false;
        this.source("gamepad", [0, 0, 0]);
        this.tell("gamepad", { there: false });
        return;
      }
      if (document.hasFocus()) {
        const velocity = sum(pads.map(gamepadVelocity));
        if (velocity.every((part) => part === 0)) this.gamepadFree = true;
        if (this.gamepadFree && velocity.some((part, i) => part !== this.sources.gamepad[i])) this.aim(velocity);
      }
      requestAnimationFrame(look);
    };
    this.tell("gamepad", { there: true });
    look();
  }

  // A stick moves with every picture: only begin and end are told at once, all between with the next of ten a second.
  aim(velocity) {
    const moves = velocity.some((part) => part !== 0);
    const moved = this.sources.gamepad.some((part) => part !== 0);
    if (moves && moved) this.sources.gamepad = velocity;
    else this.source("gamepad", velocity);
  }

  // --- head

  point(event) {
    const { kind, x, y } = event.detail;
    const camera = event.target.getAttribute("camera") || "top";
    if (kind === "drag") { // the newest one counts, once a picture
      this.drag = { kind, camera, x, y };
      if (!this.dragging) {
        this.dragging = setTimeout(() => {
          this.dragging = null;
          if (this.drag) this.send({ head: this.drag });
          this.drag = null;
        }, PERIOD / 2);
      }
      return;
    }
    this.drag = null;
    if (!this.send({ head: { kind, camera, x, y } })) this.notice("no connection to the console: the head stays");
  }
}

const links = new Map();

class WizardElement extends HTMLElement {
  connectedCallback() {
    this.link = WizardLink.of(this.getAttribute("robot") || "/");
    this.ends = new AbortController();
    this.build();
  }

  disconnectedCallback() {
    this.ends.abort();
    this.link.release();
    this.replaceChildren();
  }

  on(kind, callback) {
    this.link.addEventListener(kind, (event) => callback(event.detail), { signal: this.ends.signal });
  }
}

class WizardButtons extends WizardElement {
  build() {
    this.told = make("p", { role: "status", "aria-live": "polite", class: "told" });
    this.groups = make("div");
    this.append(this.told, this.groups);
    this.on("layout", () => this.draw());
    this.on("states", () => this.mark());
    this.on("connection", ({ open, reason }) => {
      this.told.textContent = open ? "" : `no connection to the console${reason ? `: ${reason}` : ""}`;
    });
    this.alert = make("p", { role: "alert", class: "notice" });
    this.prepend(this.alert);
    this.on("notice", ({ text }) => {
      this.alert.textContent = text;
      clearTimeout(this.fading);
      this.fading = setTimeout(() => (this.alert.textContent = ""), NOTICE_SHOWN);
    });
    if (this.link.layout) this.draw();
  }

  draw() {
    const { groups } = this.link.layout;
    this.buttons = new Map();
    this.groups.replaceChildren(...groups.map((group, i) => this.group(group, i)));
    this.told.textContent = groups.length ? "" : "There are no buttons yet: Edit makes some.";
    this.mark();
  }

  group(group, place) {
    const title = make("h2", { id: `wizard-group-${place}`, text: group.title });
    const list = make("ul", {}, ...group.buttons.map((button) => make("li", {}, this.button(button))));
    return make("section", { "aria-labelledby": title.id }, title, list);
  }

  button(button) {
    const state = make("span", { class: "state nao-state" });
    const label = make("span", { class: "label", text: button.label }, state);
    const made = make("button", { type: "button", title: button.tooltip, "data-button": button.id }, label);
    if (button.key) {
      made.setAttribute("aria-keyshortcuts", button.key);
      made.append(make("kbd", { text: button.key, "aria-hidden": "true" }));
    }
    if (button.color) {
      made.style.backgroundColor = button.color;
      made.style.color = button.text_color;
    }
    made.addEventListener("click", () => this.link.press(button.id, "click"));
    this.buttons.set(button.id, { made, state });
    return made;
  }

  mark() {
    if (!this.buttons) return;
    for (const [id, { made, state }] of this.buttons) {
      const now = this.link.unsent.has(id) ? this.link.notSent : this.link.states[id] || "";
      made.dataset.state = now;
      made.toggleAttribute("data-failed", this.link.failed.includes(now));
      state.textContent = this.link.words[now] || "";
      if (now === "used") made.setAttribute("aria-disabled", "true");
      else made.removeAttribute("aria-disabled");
      if (now === "repeats") made.setAttribute("aria-pressed", "true");
      else made.removeAttribute("aria-pressed");
    }
  }
}

class WizardDrive extends WizardElement {
  build() {
    this.velocities = { round: [0, 0, 0], flat: [0, 0, 0] };
    const round = this.pad("round", "Joystick: up and down walk, left and right turn; on a keyboard W, S, Q and E",
      (x, y) => [-y, 0, -x]);
    const flat = this.pad("flat", "Joystick sideways: left and right walk sideways; on a keyboard A and D",
      (x) => [0, -x, 0]);
    this.pads = make("div", { class: "pads" }, round, flat);
    this.range = make("input", { type: "range", min: "10", max: "100", step: "5", "aria-label": "Speed of walking" });
    this.share = make("output", {});
    this.range.addEventListener("input", () => this.setSpeed(this.range.value / 100));
    const keys = make("input", { type: "checkbox" });
    keys.checked = this.link.keysOn;
    keys.addEventListener("change", () => {
      this.link.keysOn = keys.checked;
      this.link.letGo();
    });
    this.told = make("p", { class: "told nao-state", role: "status", "aria-live": "off", text: "stands" });
    this.help = make("p", { class: "help", text: "Hold W A S D or arrows to walk, Q E to turn; let go to stop." });
    this.gamepad = make("p", { class: "help", text: "" });
    this.append(
      this.pads,
      make("label", {}, make("span", { text: "Speed" }), this.range, this.share),
      make("label", {}, keys, make("span", { text: "Keys walk and press buttons" })),
      this.told,
      this.help,
      this.gamepad,
    );
    this.on("layout", () => this.setSpeed(this.link.speed));
    this.on("walk", ({ velocity }) => this.show(velocity));
    this.on("release", () => this.free());
    this.on("gamepad", ({ there }) => this.showGamepad(there));
    this.showGamepad(this.link.gamepads().length > 0);
    this.setSpeed(this.link.speed ?? 0.5);
  }

  setSpeed(share) {
    if (this.link.layout) this.link.speed = share;
    this.range.value = String(Math.round(100 * share));
    this.share.textContent = `${this.range.value} %`;
  }

  show(velocity) {
    const moves = velocity.some((part) => part !== 0);
    const words = [["ahead", "back"], ["to the left", "to the right"], ["turning left", "turning right"]];
    const word = (part, i) => `${Math.round(100 * Math.abs(part))} % ${words[i][part > 0 ? 0 : 1]}`;
    const parts = velocity.map((part, i) => (part ? word(part, i) : "")).filter(Boolean);
    this.told.textContent = moves ? `walks: ${parts.join(", ")}` : "stands";
    this.told.classList.toggle("walks", moves);
  }

  showGamepad(there) {
    this.gamepad.textContent = there
      ? "Gamepad: hold a shoulder button; the left stick walks, the right one turns."
      : "";
  }

  // A joystick: drags of its knob are velocities, and letting go stops.
  pad(kind, label, velocity) {
    const knob = make("div", { class: "knob" });
    const pad = make("div", { class: `pad ${kind}`, role: "img", "aria-label": label }, knob);
    const aim = (event) => {
      const box = pad.getBoundingClientRect();
      let x = (event.clientX - box.left) / box.width * 2 - 1;
      let y = kind === "flat" ? 0 : (event.clientY - box.top) / box.height * 2 - 1;
      const far = Math.max(Math.hypot(x, y), 1);
      [x, y] = [x / far, y / far];
      knob.style.left = `${50 + 35 * x}%`;
      knob.style.top = `${50 + (kind === "flat" ? 0 : 35 * y)}%`;
      const still = (part) => (Math.abs(part) < DEAD_ZONE ? 0 : part);
      this.set(kind, velocity(still(x), still(y)));
    };
    pad.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || pad.dataset.pointer) return;
      pad.setPointerCapture(event.pointerId);
      pad.dataset.pointer = event.pointerId;
      pad.classList.add("held");
      aim(event);
    });
    pad.addEventListener("pointermove", (event) => {
      if (pad.dataset.pointer === String(event.pointerId)) aim(event);
    });
    const end = (event) => {
      if (pad.dataset.pointer !== String(event.pointerId)) return;
      this.centre(pad);
      this.set(kind, [0, 0, 0]);
    };
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) pad.addEventListener(name, end);
    pad.addEventListener("contextmenu", (event) => event.preventDefault());
    return pad;
  }

  set(kind, velocity) {
    const before = sum(Object.values(this.velocities)).some((part) => part !== 0);
    this.velocities[kind] = velocity;
    const total = sum(Object.values(this.velocities));
    const moves = total.some((part) => part !== 0);
    if (moves && before) this.link.sources.joystick = total; // told with the next of ten a second
    else if (moves || before) this.link.source("joystick", total);
  }

  centre(pad) {
    delete pad.dataset.pointer;
    pad.classList.remove("held");
    pad.firstChild.style.left = pad.firstChild.style.top = "50%";
  }

  free() {
    this.velocities = { round: [0, 0, 0], flat: [0, 0, 0] };
    for (const pad of this.pads.children) this.centre(pad);
  }
}

if (!customElements.get("nao-wizard-buttons")) {
  addStyle();
  customElements.define("nao-wizard-buttons", WizardButtons);
  customElements.define("nao-wizard-drive", WizardDrive);
}
