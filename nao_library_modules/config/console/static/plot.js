// <nao-plot robot="/" trace="joint:HeadYaw">: the last minute of a number that the robot tells. Joints come with the
// pose; other traces are asked for: see console/view/live_view.py for their names.

import { LiveStream, isDark, watchTheme } from "./live.js";

const SPAN = 60; // s
const MOST = 3000; // points of a trace
const INK = { light: { line: "#1565c0", text: "#222", grid: "#d5d5d5" }, dark: { line: "#64b5f6", text: "#eee", grid: "#444" } };
const STYLE = `
:host { display: block; position: relative; height: 120px; }
canvas { width: 100%; height: 100%; display: block; }
`;

function written(value) {
  const size = Math.abs(value);
  return value.toFixed(size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : 3);
}

class NaoPlot extends HTMLElement {
  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    const style = document.createElement("style");
    style.textContent = STYLE;
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    root.append(style, this.canvas);
  }

  connectedCallback() {
    this.what = this.getAttribute("trace") || "";
    this.times = [];
    this.values = [];
    this.problem = "";
    this.stream = LiveStream.of(this.getAttribute("robot") || "/");
    this.joint = this.what.startsWith("joint:") ? this.what.slice(6) : "";
    this.listeners = this.joint
      ? { pose: (event) => this.onPose(event.detail) }
      : { samples: (event) => this.onSamples(event.detail), traces: (event) => this.onTraces(event.detail) };
    for (const [kind, listener] of Object.entries(this.listeners)) this.stream.addEventListener(kind, listener);
    if (!this.joint) this.stream.want(this.what);
    this.endTheme = watchTheme(() => (this.dirty = true));
    this.sizes = new ResizeObserver(() => (this.dirty = true));
    this.sizes.observe(this);
    this.dirty = true;
    this.timer = setInterval(() => this.draw(), 100);
  }

  disconnectedCallback() {
    clearInterval(this.timer);
    this.sizes.disconnect();
    this.endTheme();
    for (const [kind, listener] of Object.entries(this.listeners)) this.stream.removeEventListener(kind, listener);
    if (!this.joint) this.stream.leave(this.what);
    this.stream.release();
  }

  onPose(pose) {
    const layout = this.stream.last("layout");
    const index = layout ? layout.joints.indexOf(this.joint) : -1;
    if (layout) this.problem = index < 0 ? `the robot has no joint ${this.joint}` : "";
    if (index >= 0) this.add(pose.stamp, pose.joints[index]);
  }

  onTraces(traces) {
    this.index = traces.traces.indexOf(this.what);
    this.problem = traces.problems[this.what] || "";
    this.dirty = true;
  }

  onSamples({ samples }) {
    for (const [index, value, stamp] of samples) if (index === this.index) this.add(stamp, value);
  }

  add(stamp, value) {
    const last = this.times[this.times.length - 1];
    if (last !== undefined && stamp < last) this.times.length = this.values.length = 0; // time began anew
    this.times.push(stamp);
    this.values.push(value);
    let old = 0;
    while (this.times.length - old > MOST || stamp - this.times[old] > SPAN) old += 1;
    if (old) {
      this.times.splice(0, old);
      this.values.splice(0, old);
    }
    this.dirty = true;
  }

  draw() {
    if (!this.dirty || document.hidden) return;
    this.dirty = false;
    const ratio = window.devicePixelRatio || 1;
    const width = this.clientWidth, height = this.clientHeight;
    if (!width || !height) return;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const pen = this.canvas.getContext("2d");
    const ink = isDark() ? INK.dark : INK.light;
    pen.scale(ratio, ratio);
    pen.font = "12px sans-serif";
    pen.fillStyle = ink.text;
    const known = this.values.filter((value) => Number.isFinite(value));
    const latest = this.values[this.values.length - 1];
    const shown = Number.isFinite(latest) ? written(latest) : "–";
    const title = `${this.what.replace(/^(joint|memory):/, "").replace(":", " ")}  ${this.problem || shown}`;
    this.canvas.setAttribute("aria-label", title);
    pen.fillText(title, 6, 13, width - 34);
    if (!known.length) return;
    let low = Math.min(...known), high = Math.max(...known);
    const margin = Math.max((high - low) * 0.08, Math.abs(high) * 0.01, 0.005);
    low -= margin;
    high += margin;
    const left = 48, top = 20, right = width - 6, bottom = height - 16;
    const end = this.times[this.times.length - 1];
    const x = (time) => right - ((end - time) / SPAN) * (right - left);
    const y = (value) => bottom - ((value - low) / (high - low)) * (bottom - top);
    pen.strokeStyle = ink.grid;
    pen.beginPath();
    for (const [value, down] of [[low, -1], [high, 9]]) {
      pen.moveTo(left, y(value));
      pen.lineTo(right, y(value));
      pen.fillText(written(value), 4, y(value) + down);
    }
    for (const seconds of [60, 40, 20, 0]) {
      pen.moveTo(x(end - seconds), top);
      pen.lineTo(x(end - seconds), bottom);
      pen.fillText(seconds ? `-${seconds} s` : "", x(end - seconds) + 2, height - 3);
    }
    pen.stroke();
    pen.strokeStyle = ink.line;
    pen.lineWidth = 1.5;
    pen.beginPath();
    let drawn = false;
    this.times.forEach((time, i) => {
      if (!Number.isFinite(this.values[i])) drawn = false;
      else if (drawn) pen.lineTo(x(time), y(this.values[i]));
      else {
        pen.moveTo(x(time), y(this.values[i]));
        drawn = true;
      }
    });
    pen.stroke();
  }
}

if (!customElements.get("nao-plot")) customElements.define("nao-plot", NaoPlot);
