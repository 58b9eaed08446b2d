// <nao-camera robot="/" camera="top">: what a camera sees, live. Clicks and drags are events `nao-point` with
// detail {kind: "click" | "start" | "drag" | "end", x, y, dx, dy}: x and y from 0, left and top, to 1; dx and dy since
// the start of the drag. Keys: arrows move a cross, Enter clicks there, Shift and arrows drag.

import { Socket, readPicture } from "./live.js";

const STEP = 0.05;
const CLICK = 0.015; // share of the picture that a finger may slip in a click
const STALE = 3000; // ms

const STYLE = `
:host { display: block; position: relative; aspect-ratio: 4 / 3; background: #111; border-radius: 6px;
  overflow: hidden; touch-action: none; }
canvas { width: 100%; height: 100%; display: block; cursor: crosshair; }
canvas:focus-visible { outline: 3px solid #5898d4; outline-offset: -3px; }
p { position: absolute; left: 0; right: 0; bottom: 0; margin: 0; padding: 4px 8px; color: #fff;
  background: rgba(0, 0, 0, 0.65); font: 13px sans-serif; }
p:empty { display: none; }
i { position: absolute; width: 18px; height: 18px; margin: -9px 0 0 -9px; border: 2px solid #fff; border-radius: 50%;
  box-shadow: 0 0 0 1px #000; pointer-events: none; display: none; }
`;

class NaoCamera extends HTMLElement {
  static observedAttributes = ["robot", "camera"];

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    const style = document.createElement("style");
    style.textContent = STYLE;
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.note = document.createElement("p");
    this.note.setAttribute("aria-live", "polite");
    this.cross = document.createElement("i");
    this.at = { x: 0.5, y: 0.5 };
    root.append(style, this.canvas, this.note, this.cross);
    this.canvas.addEventListener("pointerdown", (event) => this.press(event));
    this.canvas.addEventListener("pointermove", (event) => this.move(event));
    this.canvas.addEventListener("pointerup", (event) => this.lift(event));
    this.canvas.addEventListener("pointercancel", (event) => this.lift(event));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    this.canvas.addEventListener("blur", () => (this.cross.style.display = "none"));
  }

  connectedCallback() {
    this.start();
    this.clock = setInterval(() => this.look(), 1000);
  }

  disconnectedCallback() {
    clearInterval(this.clock);
    this.stop();
  }

  attributeChangedCallback() {
    if (this.socket) this.start();
  }

  start() {
    this.stop();
    const camera = this.getAttribute("camera") || "top";
    this.canvas.setAttribute("aria-label", `${camera} camera`);
    this.note.textContent = "waits for the first picture";
    this.seen = 0;
    this.socket = new Socket("/console/camera", { robot: this.getAttribute("robot") || "/", camera }, (data) => this.show(data),
      (open, reason) => { if (!open) this.note.textContent = reason || "no connection to the console"; });
  }

  stop() {
    if (this.socket) this.socket.close();
    this.socket = null;
  }

  async show(data) {
    if (typeof data === "string") {
      this.note.textContent = JSON.parse(data).text || "";
      return;
    }
    const picture = readPicture(data);
    if (!picture || this.busy) return; // a slow browser shows every other picture
    this.busy = true;
    try {
      const image = await createImageBitmap(picture.blob);
      if (this.canvas.width !== image.width) this.canvas.width = image.width;
      if (this.canvas.height !== image.height) this.canvas.height = image.height;
      this.style.aspectRatio = `${image.width} / ${image.height}`;
      this.canvas.getContext("2d").drawImage(image, 0, 0);
      image.close();
      this.seen = performance.now();
      this.note.textContent = "";
    } catch {
      this.note.textContent = "a picture that this browser cannot show";
    } finally {
      this.busy = false;
    }
  }

  look() {
    if (this.seen && performance.now() - this.seen > STALE) {
      this.note.textContent = `no picture for ${Math.round((performance.now() - this.seen) / 1000)} s`;
    }
  }

  point(event) {
    const box = this.canvas.getBoundingClientRect();
    const inside = (value) => Math.min(Math.max(value, 0), 1);
    return { x: inside((event.clientX - box.left) / box.width), y: inside((event.clientY - box.top) / box.height) };
  }

  tell(kind, at, start) {
    const detail = { kind, x: at.x, y: at.y, dx: at.x - start.x, dy: at.y - start.y };
    this.dispatchEvent(new CustomEvent("nao-point", { detail, bubbles: true, composed: true }));
  }

  press(event) {
    if (event.button !== 0) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.begin = this.point(event);
    this.dragged = false;
  }

  move(event) {
    if (!this.begin) return;
    const at = this.point(event);
    if (!this.dragged && Math.hypot(at.x - this.begin.x, at.y - this.begin.y) > CLICK) {
      this.dragged = true;
      this.tell("start", this.begin, this.begin);
    }
    if (this.dragged) this.tell("drag", at, this.begin);
  }

  lift(event) {
    if (!this.begin) return;
    const at = this.point(event);
    if (this.dragged) this.tell("end", at, this.begin);
    else if (event.type === "pointerup") this.tell("click", this.begin, this.begin);
    this.begin = null;
  }

  key(event) {
    const ways = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, -STEP], ArrowDown: [0, STEP] };
    const way = ways[event.key];
    if (!way && event.key !== "Enter") return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key === "Enter") {
      this.tell("click", this.at, this.at);
      return;
    }
    if (event.shiftKey) {
      const to = { x: 0.5 + way[0], y: 0.5 + way[1] };
      this.tell("start", { x: 0.5, y: 0.5 }, { x: 0.5, y: 0.5 });
      this.tell("drag", to, { x: 0.5, y: 0.5 });
      this.tell("end", to, { x: 0.5, y: 0.5 });
      return;
    }
    const inside = (value) => Math.min(Math.max(value, 0), 1);
    this.at = { x: inside(this.at.x + way[0]), y: inside(this.at.y + way[1]) };
    this.cross.style.display = "block";
    this.cross.style.left = `${100 * this.at.x}%`;
    this.cross.style.top = `${100 * this.at.y}%`;
  }
}

if (!customElements.get("nao-camera")) customElements.define("nao-camera", NaoCamera);
