// Escape stops the robot from every page: by a request of its own, for the page's connection may be gone.

const header = () => document.querySelector("[data-robot]");

async function stop() {
  const robot = header()?.dataset.robot ?? "";
  const button = document.querySelector(".nao-stop");
  try {
    const answer = await fetch(`/console/stop?robot=${encodeURIComponent(robot)}`, { method: "POST", keepalive: true });
    button?.classList.toggle("nao-stop-failed", !answer.ok);
  } catch {
    button?.classList.add("nao-stop-failed"); // the console is gone: a robot's goals end with it
  }
}

window.addEventListener(
  "keydown",
  (event) => {
    if (event.key === "Escape" && !event.repeat) stop();
  },
  { capture: true },
);
