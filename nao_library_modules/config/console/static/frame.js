// The stop of every page: by a request of its own, for the page's connection may be gone.

const header = () => document.querySelector("[data-robot]");

function tell(message, type) {
  window.Quasar?.Notify?.create({ message, type });
}

async function stop() {
  const robot = header()?.dataset.robot ?? "";
  const button = document.querySelector(".nao-stop");
  try {
    const answer = await fetch(`/console/stop?robot=${encodeURIComponent(robot)}`, { method: "POST", keepalive: true });
    button?.classList.toggle("nao-stop-failed", !answer.ok);
    if (answer.ok) tell("Everything is told to stop", "positive");
    else tell((await answer.json()).error, "warning");
  } catch {
    button?.classList.add("nao-stop-failed"); // the console is gone: a robot's goals end with it
    tell("The console does not answer: nothing was stopped", "negative");
  }
}

window.addEventListener(
  "keydown",
  (event) => {
    if (event.key === "Escape" && !event.repeat) stop();
  },
  { capture: true },
);
window.addEventListener("click", (event) => event.target.closest?.(".nao-stop") && stop(), { capture: true });
