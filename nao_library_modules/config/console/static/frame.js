// The stop of every page: on a line of its own that is open already, and by a request as well; what comes first counts.

const header = () => document.querySelector("[data-robot]");
const PATH = "/console/stop";
const AGAIN = 2000; // ms until a line that broke is opened again
const waiting = new Map(); // id of a stop -> what takes its answer
let line = null;

function tell(message, type) {
  window.Quasar?.Notify?.create({ message, type });
}

function connect() {
  line = new WebSocket(location.origin.replace(/^http/, "ws") + PATH);
  line.addEventListener("message", (event) => {
    const answer = JSON.parse(event.data);
    waiting.get(answer.id)?.(answer);
  });
  line.addEventListener("close", () => setTimeout(connect, AGAIN));
}

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

async function stop() {
  const robot = header()?.dataset.robot ?? "";
  const id = `${Date.now()}-${Math.random()}`;
  const button = document.querySelector(".nao-stop");
  try {
    const answer = await Promise.any([byLine(robot, id), byRequest(robot, id)]);
    button?.classList.toggle("nao-stop-failed", Boolean(answer.error));
    if (answer.error) tell(answer.error, "warning");
    else tell("Everything is told to stop", "positive");
  } catch {
    button?.classList.add("nao-stop-failed"); // the console is gone: a robot's goals end with it
    tell("The console does not answer: nothing was stopped", "negative");
  } finally {
    waiting.delete(id);
  }
}

connect();
window.addEventListener(
  "keydown",
  (event) => {
    if (event.key === "Escape" && !event.repeat) stop();
  },
  { capture: true },
);
window.addEventListener("click", (event) => event.target.closest?.(".nao-stop") && stop(), { capture: true });
