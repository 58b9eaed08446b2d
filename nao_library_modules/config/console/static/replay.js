// A trial as a timeline with its video: what happened, in lanes, over ROS time. Texts come from logs, and are only ever
// set as text.

const LANES = [
  ["Steps", null],
  ["Goals", null],
  ["Said", ["said"]],
  ["Felt", ["touched", "felt"]],
  ["Heard", ["heard"]],
  ["Seen", ["seen"]],
  ["Wizard", ["pressed", "walked", "failed"]],
  ["Alarms", ["state", "alarm"]],
  ["Notes", ["note", "deviation"]],
];
const COLOURS = {
  done: "#2e7d32", succeeded: "#2e7d32", aborted: "#c62828", preempted: "#757575", timeout: "#b26a00", skipped: "#757575", failed: "#c62828", repeated: "#5e35b1", stopped: "#757575",
  "": "#1565c0", note: "#1565c0", deviation: "#c62828", other: "#1565c0",
};
const LABELS = 84, ROW = 30, AXIS = 26;
const SPEEDS = [0.25, 0.5, 1, 2, 4];

function element(name, parent, text = "", attributes = {}) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text) made.textContent = text;
  parent.append(made);
  return made;
}

class Replay {
  constructor(root, trial) {
    this.trial = trial;
    this.began = trial.began;
    this.length = Math.max(trial.ended - trial.began, 0.1);
    this.time = 0;
    this.speed = 1;
    this.playing = false;
    this.view = [0, this.length];
    this.lanes = LANES.filter(([, kinds]) => kinds === null || trial.events.some((e) => kinds.includes(e.kind)));
    this.bars = { Steps: trial.steps, Goals: trial.goals };
    this.build(root);
    this.resized = new ResizeObserver(() => this.draw());
    this.resized.observe(this.canvas);
    this.draw();
    this.tell();
  }

  build(root) {
    root.classList.add("replay");
    const media = element("div", root, "", { class: "replay-media" });
    this.media = [];
    for (const file of this.trial.media) {
      const kind = file.kind === "video" ? "video" : "audio";
      const made = element(kind, media, "", { src: file.url, preload: "auto", "aria-label": `${kind} of the trial` });
      if (kind === "video") made.setAttribute("style", "max-width:100%;max-height:45vh;background:#000");
      made.addEventListener("loadeddata", () => this.seek(this.time));
      this.media.push({ made, from: file.began - this.began });
    }
    const bar = element("div", root, "", { class: "replay-bar", style: "display:flex;gap:8px;align-items:center;margin:8px 0" });
    this.button = element("button", bar, "Play", { type: "button", style: "min-width:72px;padding:6px 12px" });
    this.button.addEventListener("click", () => this.toggle());
    const label = element("label", bar, "Speed ");
    const speeds = element("select", label, "", { "aria-label": "speed of the replay" });
    for (const speed of SPEEDS) element("option", speeds, `${speed}`, speed === 1 ? { selected: "" } : {});
    speeds.addEventListener("change", () => this.setSpeed(Number(speeds.value)));
    const whole = element("button", bar, "Whole trial", { type: "button", style: "padding:6px 12px" });
    whole.addEventListener("click", () => { this.view = [0, this.length]; this.draw(); });
    this.clock = element("span", bar, "", { role: "status", style: "font-variant-numeric:tabular-nums" });
    this.canvas = element("canvas", root, "", {
      tabindex: "0", role: "slider", "aria-label": "time of the trial; arrows move by a second, with shift by ten",
      "aria-valuemin": "0", "aria-valuemax": this.length.toFixed(1),
      style: `width:100%;height:${AXIS + ROW * this.lanes.length}px;display:block;touch-action:none`,
    });
    this.now = element("div", root, "", { "aria-live": "polite", style: "min-height:1.5em;margin:6px 0" });
    this.list = element("ol", root, "", {
      "aria-label": "events of the trial", tabindex: "0",
      style: "max-height:30vh;overflow:auto;margin:0;padding:0;list-style:none;font-size:13px",
    });
    this.rows = this.trial.events.map((event) => {
      const row = element("li", this.list);
      const at = element("button", row, `${(event.stamp - this.began).toFixed(2)} s`, {
        type: "button", style: "min-width:80px;text-align:right;margin-right:10px;text-decoration:underline",
      });
      at.addEventListener("click", () => this.seek(event.stamp - this.began));
      element("span", row, `${event.kind}${event.by ? ` (${event.by})` : ""}: ${event.text}`);
      return row;
    });
    this.listen();
  }

  listen() {
    const canvas = this.canvas;
    let from = null;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      from = { x: event.offsetX, view: [...this.view], moved: false };
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      const shift = ((from.x - event.offsetX) / (canvas.clientWidth - LABELS)) * (from.view[1] - from.view[0]);
      from.moved ||= Math.abs(event.offsetX - from.x) > 4;
      if (from.moved) this.show(from.view[0] + shift, from.view[1] + shift);
    });
    canvas.addEventListener("pointerup", (event) => {
      if (from && !from.moved && event.offsetX > LABELS) this.seek(this.timeAt(event.offsetX));
      from = null;
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const at = this.timeAt(event.offsetX), factor = event.deltaY > 0 ? 1.25 : 0.8;
      this.show(at - (at - this.view[0]) * factor, at + (this.view[1] - at) * factor);
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const step = event.shiftKey ? 10 : 1;
      const moves = { ArrowLeft: this.time - step, ArrowRight: this.time + step, Home: 0, End: this.length };
      if (event.key in moves) this.seek(moves[event.key]);
      else if (event.key === " ") this.toggle();
      else return;
      event.preventDefault();
    });
  }

  show(begin, end) {
    const width = Math.min(Math.max(end - begin, 0.5), this.length);
    const first = Math.min(Math.max(begin, 0), this.length - width);
    this.view = [first, first + width];
    this.draw();
  }

  timeAt(x) {
    return this.view[0] + ((x - LABELS) / (this.canvas.clientWidth - LABELS)) * (this.view[1] - this.view[0]);
  }

  placeOf(time) {
    return LABELS + ((time - this.view[0]) / (this.view[1] - this.view[0])) * (this.canvas.clientWidth - LABELS);
  }

  toggle() {
    this.playing = !this.playing;
    this.button.textContent = this.playing ? "Pause" : "Play";
    if (this.playing && this.time >= this.length) this.time = 0;
    this.last = performance.now();
    this.follow(true);
    if (this.playing) requestAnimationFrame((now) => this.frame(now));
  }

  setSpeed(speed) {
    this.speed = speed;
    for (const { made } of this.media) made.playbackRate = speed;
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.length);
    if (this.time < this.view[0] || this.time > this.view[1]) {
      const half = (this.view[1] - this.view[0]) / 2;
      this.show(this.time - half, this.time + half);
    }
    this.follow(true);
    this.draw();
    this.tell();
  }

  frame(now) {
    if (!this.playing || !this.canvas.isConnected) return;
    this.time += ((now - this.last) / 1000) * this.speed;
    this.last = now;
    if (this.time >= this.length) {
      this.time = this.length;
      this.toggle();
    }
    this.follow(false);
    this.draw();
    this.tell();
    requestAnimationFrame((next) => this.frame(next));
  }

  // The pictures follow the time of the trial: a drift of more than a fifth of a second is corrected.
  follow(sought) {
    for (const { made, from } of this.media) {
      const at = this.time - from, inside = at >= 0 && at <= (made.duration || 0);
      if (inside && (sought || Math.abs(made.currentTime - at) > 0.2)) made.currentTime = at;
      if (this.playing && inside && made.paused) made.play().catch(() => {});
      if ((!this.playing || !inside) && !made.paused) made.pause();
    }
  }

  tell() {
    this.clock.textContent = `${this.time.toFixed(1)} s of ${this.length.toFixed(1)} s`;
    this.canvas.setAttribute("aria-valuenow", this.time.toFixed(1));
    const step = this.trial.steps.find((s) => s.began - this.began <= this.time && this.time <= s.ended - this.began);
    const text = step ? `${step.path} ${step.text}${step.answer ? `: ${step.answer}` : ""}` : "";
    if (this.now.textContent !== text) this.now.textContent = text;
    const behind = this.trial.events.findIndex((e) => e.stamp - this.began > this.time + 0.01);
    const index = (behind < 0 ? this.rows.length : behind) - 1;
    if (index !== this.index && this.rows[index]) {
      if (this.rows[this.index]) this.rows[this.index].style.fontWeight = "";
      this.rows[index].style.fontWeight = "bold";
      this.list.scrollTop = this.rows[index].offsetTop - this.list.offsetTop - 60;
      this.index = index;
    }
  }

  draw() {
    const canvas = this.canvas, ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const pen = canvas.getContext("2d"), ink = getComputedStyle(canvas).color;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "12px sans-serif";
    pen.textBaseline = "middle";
    this.axis(pen, ink, width, height);
    this.lanes.forEach(([name, kinds], i) => {
      const top = AXIS + i * ROW;
      pen.fillStyle = ink;
      pen.fillText(name, 4, top + ROW / 2);
      pen.save();
      pen.beginPath();
      pen.rect(LABELS, top, width - LABELS, ROW);
      pen.clip();
      if (kinds === null) this.spans(pen, top, this.bars[name]);
      else this.events(pen, top, kinds, ink);
      pen.restore();
    });
    const x = this.placeOf(this.time);
    if (x >= LABELS) {
      pen.fillStyle = "#d50000";
      pen.fillRect(x - 1, 0, 2, height);
    }
  }

  axis(pen, ink, width, height) {
    const span = this.view[1] - this.view[0];
    const unit = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1800].find((u) => (u / span) * width > 70) || 3600;
    pen.fillStyle = ink;
    pen.strokeStyle = ink;
    pen.globalAlpha = 0.75;
    for (let t = Math.ceil(this.view[0] / unit) * unit; t <= this.view[1]; t += unit) {
      const x = this.placeOf(t);
      pen.fillText(`${Number(t.toFixed(1))} s`, x + 3, AXIS / 2);
      pen.globalAlpha = 0.2;
      pen.fillRect(x, 0, 1, height);
      pen.globalAlpha = 0.75;
    }
    pen.globalAlpha = 1;
  }

  spans(pen, top, spans) {
    for (const step of spans) {
      const left = this.placeOf(step.began - this.began), right = this.placeOf(step.ended - this.began);
      pen.fillStyle = COLOURS[step.outcome] || COLOURS.other;
      pen.fillRect(left, top + 3, Math.max(right - left - 1, 2), ROW - 6);
      if (right - left < 24) continue;
      pen.save();
      pen.beginPath();
      pen.rect(left, top, right - left - 3, ROW);
      pen.clip();
      pen.fillStyle = "#fff";
      pen.fillText(`${step.path} ${step.text}`.trim(), left + 4, top + ROW / 2);
      pen.restore();
    }
  }

  events(pen, top, kinds, ink) {
    const shown = this.trial.events.filter((event) => kinds.includes(event.kind));
    const places = shown.map((event) => this.placeOf(event.stamp - this.began));
    shown.forEach((event, i) => {
      const x = places[i], room = (i + 1 < shown.length ? places[i + 1] : x + 2000) - x - 16;
      pen.fillStyle = COLOURS[event.kind] || COLOURS.other;
      pen.beginPath();
      pen.arc(x, top + ROW / 2, 5, 0, 7);
      pen.fill();
      if (room < 24) return;
      pen.save();
      pen.beginPath();
      pen.rect(x, top, room + 8, ROW);
      pen.clip();
      pen.fillStyle = ink;
      pen.fillText(event.text, x + 8, top + ROW / 2);
      pen.restore();
    });
  }
}

export async function mount(id, url) {
  const root = document.getElementById(id);
  const answer = await fetch(url);
  if (!answer.ok) {
    root.textContent = `The trial cannot be shown: ${answer.status} ${await answer.text()}`;
    return;
  }
  root.replay = new Replay(root, await answer.json());
}
