// A press is for the moment in which it is made: one that cannot reach the console now is refused, and never sent later.
// It is said in a line until somebody has looked, and the console is told as soon as it can be: see pages/frame.py.
// One that was sent when the connection broke may be lost on its way: it is told as well, and the console leaves out those
// that it has, by their `press_id`.

const PATH = "/console/unsent", STORE = "nao-unsent";
const AGAIN = 2000; // ms until the console is tried again
const PRESSES = ["click", "key", "keydown", "keyup"]; // types of NiceGUI's events
const LONGEST_LABEL = 100;
const ARRIVES = 1000; // ms after which the console has a press, if its pulse goes on

const header = () => document.querySelector("[data-robot]");
const sent = new Map(); // press_id -> press that the console may not have yet
let telling = false;

const load = () => JSON.parse(sessionStorage.getItem(STORE) ?? "[]");

function keep(unsent) {
  sessionStorage.setItem(STORE, JSON.stringify(unsent));
  draw(unsent.filter((press) => !press.seen));
}

function make(name, properties, ...children) {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
}

function draw(unsent) {
  document.querySelector(".nao-unsent")?.replaceChildren(...unsent.map((press) => {
    const clock = new Date(press.time).toLocaleTimeString("en-GB");
    const what = `${press.doubt ? "perhaps " : ""}${header().dataset.notSent}`;
    const text = `${clock}  ${press.label}: ${what}: there is no connection to the console`;
    const seen = () => keep(load().map((each) => (each.time === press.time ? { ...each, seen: true } : each)));
    const button = make("button", { type: "button", textContent: "Seen", onclick: seen });
    return make("p", {}, make("span", { textContent: text }), button);
  }));
}

function described(press) {
  const press_id = `${Date.now()}-${Math.random()}`;
  return { ...press, press_id, page: location.pathname, robot: header().dataset.robot, time: Date.now() };
}

// Refuse a press: {label, via}, and {group, of} of a button of the wizard's page.
export function refuse(press) {
  keep([...load(), described(press)]);
  tell();
}

// A press is sent with this id.
export function sending(press) {
  const made = described(press);
  sent.set(made.press_id, made);
  return made.press_id;
}

// The console's pulse is there: it has what was sent a while ago.
export function arrived() {
  for (const [id, press] of sent) if (Date.now() - press.time > ARRIVES) sent.delete(id);
}

// The console does not answer: whether it has what was sent last, nobody knows.
export function doubt() {
  if (!sent.size) return;
  keep([...load(), ...[...sent.values()].map((press) => ({ ...press, doubt: true }))]);
  sent.clear();
  tell();
}

export async function tell() {
  if (telling) return;
  const unsent = load();
  if (!unsent.length) return;
  telling = true;
  try {
    const told = unsent.map((press) => ({ ...press, age: (Date.now() - press.time) / 1000 }));
    const headers = { "content-type": "application/json" };
    const answer = await fetch(PATH, { method: "POST", headers, body: JSON.stringify(told) });
    if (!answer.ok) throw new Error(answer.statusText);
    const times = new Set(unsent.map((press) => press.time));
    keep(load().filter((press) => !times.has(press.time)));
  } catch {
    setTimeout(tell, AGAIN); // there is no console yet
  } finally {
    telling = false;
  }
}

// What is pressed, as NiceGUI tells the console: {label, via}; null: it is no press, or a key that is let go.
export function pressOf(message) {
  const element = mounted_app.elements[message.id];
  const type = element?.events?.find((each) => each.listener_id === message.listener_id)?.type;
  if (!PRESSES.includes(type)) return null;
  if (type === "key") {
    const { key, action, repeat } = JSON.parse(message.args[0]);
    return { label: `Key ${key}`, via: "key", silent: action !== "keydown" || repeat || key.length > 1 };
  }
  const shown = document.getElementById(`c${message.id}`);
  const label = shown?.ariaLabel || shown?.innerText?.trim().split("\n").pop() || "";
  return { label: label.slice(0, LONGEST_LABEL), via: type === "click" ? "click" : "key", silent: type === "keyup" };
}

window.addEventListener("load", () => (keep(load()), tell()));
