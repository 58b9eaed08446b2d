// Tracks of a behaviour as SVG: boxes that are chosen, dragged and stretched by pointer or by keys. Texts of behaviours
// go into the page as textContent only. What a person does is an event of the container; Python answers with new tracks.

const SVG = "http://www.w3.org/2000/svg";
const ROW = 32, RULER = 24, LEFT = 12, RIGHT = 24, EDGE = 8, NARROWEST = 10;
const SNAP = 0.05, KEY_STEP = 0.1, CLICK = 4;
const SCALES = { least: 4, most: 800 };
const views = new Map();

const style = document.createElement("link");
style.rel = "stylesheet";
style.href = new URL("timeline.css", import.meta.url).href;
document.head.append(style);

function draw(parent, name, attributes = {}, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

const seconds = (value) => `${Math.round(value * 100) / 100} s`;

class View {
  constructor(container) {
    this.container = container;
    this.scale = 0;
    this.tracks = { boxes: [], links: [], rows: 0, length: 0 };
    this.selected = "";
    this.states = {};
    container.addEventListener("keydown", (event) => this.key(event));
    container.addEventListener("wheel", (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.zoom(event.deltaY < 0 ? 1.2 : 1 / 1.2);
    }, { passive: false });
  }

  tell(name, detail) {
    this.container.dispatchEvent(new CustomEvent(name, { detail }));
  }

  x(time) { return LEFT + time * this.scale; }

  fit() {
    const width = Math.max(this.container.clientWidth - LEFT - RIGHT - 24, 200);
    this.scale = Math.min(Math.max(width / Math.max(this.tracks.length, 1), SCALES.least), 400);
    this.render();
  }

  zoom(factor) {
    this.scale = Math.min(Math.max(this.scale * factor, SCALES.least), SCALES.most);
    this.render();
  }

  show(tracks, selected, whole) {
    this.tracks = tracks;
    this.selected = selected;
    if (whole || !this.scale) this.fit(); else this.render();
  }

  render() {
    const focused = this.container.contains(document.activeElement) ? document.activeElement.dataset.path : null;
    const { boxes, links, rows, length } = this.tracks;
    const width = Math.max(this.x(length) + RIGHT, this.container.clientWidth - 4);
    const height = RULER + Math.max(rows, 1) * ROW + 8;
    const left = this.container.scrollLeft, top = this.container.scrollTop;
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("width", width);
    svg.setAttribute("height", height);
    this.ruler(svg, width, height);
    this.groups = new Map();
    const reachable = boxes.some((box) => box.path === this.selected) ? this.selected : boxes.length ? boxes[0].path : "";
    for (const box of boxes) this.box(svg, box, box.path === reachable);
    for (const [from, to] of links) this.link(svg, from, to);
    this.line = draw(svg, "line", { class: "tl-cursor", x1: -9, x2: -9, y1: 0, y2: height, "aria-hidden": "true" });
    this.container.replaceChildren(svg);
    this.container.scrollLeft = left;
    this.container.scrollTop = top;
    this.mark(this.states, this.at);
    if (focused && this.groups.has(focused)) this.groups.get(focused).focus({ preventScroll: true });
    else if (focused && this.groups.has(this.selected)) this.groups.get(this.selected).focus({ preventScroll: true });
  }

  ruler(svg, width, height) {
    const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60, 120, 300, 600];
    const step = steps.find((each) => each * this.scale >= 50) || 600;
    for (let number = 0; this.x(number * step) < width; number++) {
      const x = this.x(number * step);
      draw(svg, "line", { class: "tl-grid", x1: x, x2: x, y1: RULER - 6, y2: height, "aria-hidden": "true" });
      draw(svg, "text", { class: "tl-tick", x: x + 3, y: RULER - 10, "aria-hidden": "true" }, seconds(number * step));
    }
  }

  place(box) {
    const barrier = box.kind === "barrier";
    const x = this.x(box.begin) - (barrier ? 3 : 0);
    const width = barrier ? 6 : Math.max((box.end - box.begin) * this.scale, NARROWEST);
    return { x, y: RULER + box.row * ROW + 2, width, height: box.rows * ROW - 4 };
  }

  box(svg, box, reachable) {
    const { x, y, width, height } = this.place(box);
    const group = draw(svg, "g", {
      class: "tl-step", role: "button", tabindex: reachable ? 0 : -1, "aria-label": this.name(box),
      "aria-current": box.path === this.selected,
    });
    Object.assign(group.dataset, { path: box.path, kind: box.kind, server: box.server, moves: box.moves });
    if (!box.sure && box.kind === "goal") group.classList.add("tl-guess");
    if (box.problem) group.classList.add("tl-wrong");
    draw(group, "title", {}, this.name(box));
    draw(group, "rect", { class: "tl-body", x, y, width, height, rx: 4 });
    draw(group, "rect", { class: "tl-mark", x, y: y + Math.min(height, ROW - 4) - 4, width, height: 4 });
    if (box.kind !== "barrier") {
      const inner = draw(group, "svg", { x, y, width: Math.max(width - 3, 1), height: ROW - 4 });
      const what = box.kind === "goal" ? box.title.slice(box.title.lastIndexOf(".") + 1) : box.title;
      const title = box.label ? `${box.label} · ${what}` : what;
      draw(inner, "text", { class: "tl-title", x: 5, y: 12 }, title);
      if (box.text) draw(inner, "text", { x: 5, y: 24 }, box.text);
      if (box.stretches) draw(group, "rect", { class: "tl-edge", x: x + width - EDGE, y, width: EDGE, height });
    }
    group.addEventListener("pointerdown", (event) => this.press(event, box, group));
    group.addEventListener("focus", () => { if (this.selected !== box.path) this.choose(box.path); });
    this.groups.set(box.path, group);
  }

  name(box) {
    const parts = [`step ${box.path}`, box.title, box.text, box.label && `label ${box.label}`];
    parts.push(`begins at ${seconds(box.begin)}`, `takes ${box.sure ? "" : "about "}${seconds(box.end - box.begin)}`);
    if (box.problem) parts.push(`wrong: ${box.problem}`);
    return parts.filter(Boolean).join(", ");
  }

  link(svg, from, to) {
    const source = this.tracks.boxes.find((box) => box.path === from);
    const target = this.tracks.boxes.find((box) => box.path === to);
    if (!source || !target) return;
    const a = this.place(source), b = this.place(target);
    const below = b.y > a.y;
    const fromX = Math.min(b.x, a.x + a.width), fromY = below ? a.y + a.height : a.y;
    draw(svg, "path", { class: "tl-link", d: `M${fromX} ${fromY}L${b.x} ${below ? b.y : b.y + b.height}`, "aria-hidden": "true" });
  }

  choose(path) {
    this.selected = path;
    for (const [each, group] of this.groups) {
      group.setAttribute("aria-current", each === path);
      group.setAttribute("tabindex", each === path ? 0 : -1);
    }
    this.tell("tlselect", { path });
  }

  mark(states, at) {
    this.states = states;
    this.at = at;
    for (const [path, group] of this.groups || []) {
      if (states[path]) group.dataset.state = states[path]; else delete group.dataset.state;
    }
    const x = at === null || at === undefined ? -9 : this.x(at);
    this.line.setAttribute("x1", x);
    this.line.setAttribute("x2", x);
    const seen = this.container;
    if (x > seen.scrollLeft + seen.clientWidth - 20) seen.scrollLeft = x - 60;
  }

  // --- pointer ------------------------------------------------------------------------------------------------------

  press(event, box, group) {
    event.stopPropagation();
    if (event.button !== 0) return;
    group.focus({ preventScroll: true });
    const stretch = box.stretches && event.target.classList.contains("tl-edge");
    const start = { x: event.clientX, y: event.clientY };
    const body = group.querySelector(".tl-body");
    const { width } = this.place(box);
    let moved = false, target = null;
    const snapped = (value, fine) => (fine ? value : Math.round(value / SNAP) * SNAP);
    const delta = (now) => snapped((now.clientX - start.x) / this.scale, now.altKey);
    const move = (now) => {
      if (Math.hypot(now.clientX - start.x, now.clientY - start.y) < CLICK && !moved) return;
      if (!stretch && !box.moves) return;
      moved = true;
      group.classList.add("tl-dragged");
      if (stretch) {
        body.setAttribute("width", Math.max(width + delta(now) * this.scale, 2));
        return;
      }
      const down = now.clientY - start.y;
      const sideways = box.moves === "time" && Math.abs(down) < ROW;
      target?.group.classList.remove("tl-target");
      target = sideways ? null : this.under(now, box);
      target?.group.classList.add("tl-target");
      group.setAttribute("transform", `translate(${sideways ? delta(now) * this.scale : now.clientX - start.x} ${sideways ? 0 : down})`);
    };
    const release = (now) => {
      for (const [name, handler] of handlers) window.removeEventListener(name, handler);
      if (!moved) return;
      group.classList.remove("tl-dragged");
      target?.group.classList.remove("tl-target");
      group.removeAttribute("transform");
      body.setAttribute("width", width);
      if (now.type === "pointercancel") return;
      const by = delta(now);
      if (stretch) {
        const former = box.end - box.begin;
        this.tell("tlstretch", { path: box.path, former, seconds: Math.max(former + by, 0) });
      } else if (target) {
        this.tell("tlmove", { path: box.path, target: target.box.path, inside: target.inside, after: target.after });
      } else if (box.moves === "time" && by) {
        this.tell("tlshift", { path: box.path, seconds: by });
      }
    };
    const handlers = [["pointermove", move], ["pointerup", release], ["pointercancel", release]];
    for (const [name, handler] of handlers) window.addEventListener(name, handler);
    if (event.pointerType !== "mouse" && event.cancelable && this.selected === box.path) group.style.touchAction = "none";
  }

  under(event, dragged) {
    for (const element of document.elementsFromPoint(event.clientX, event.clientY)) {
      const group = element.closest?.("g.tl-step");
      if (!group || !this.container.contains(group)) continue;
      const path = group.dataset.path;
      if (path === dragged.path || path.startsWith(`${dragged.path}.`)) continue;
      const box = this.tracks.boxes.find((each) => each.path === path);
      const area = group.querySelector(".tl-body").getBoundingClientRect();
      const inside = ["parallel", "race", "timeline", "repeat", "sequence"].includes(box.kind);
      return { box, group, inside, after: event.clientX > area.left + area.width / 2 };
    }
    return null;
  }

  // --- keys -----------------------------------------------------------------------------------------------------------

  key(event) {
    const box = this.tracks.boxes.find((each) => each.path === this.selected);
    const command = event.ctrlKey || event.metaKey;
    const large = event.shiftKey ? 10 : 1;
    let done = true;
    if (command && event.key.toLowerCase() === "z") this.tell("tlkey", { key: event.shiftKey ? "redo" : "undo", path: this.selected });
    else if (command && event.key.toLowerCase() === "y") this.tell("tlkey", { key: "redo", path: this.selected });
    else if (command || event.altKey) done = false;
    else if (event.key === "+" || event.key === "=") this.zoom(1.25);
    else if (event.key === "-") this.zoom(0.8);
    else if (event.key === "0") this.fit();
    else if (!box) done = false;
    else if (event.shiftKey && (event.key === "ArrowLeft" || event.key === "ArrowRight")) this.nudge(box, event.key === "ArrowRight" ? 1 : -1);
    else if (event.key === "ArrowLeft" || event.key === "ArrowUp") this.step(-1);
    else if (event.key === "ArrowRight" || event.key === "ArrowDown") this.step(1);
    else if (event.key === "Home") this.step(-Infinity);
    else if (event.key === "End") this.step(Infinity);
    else if ("[]{}".includes(event.key)) this.longer(box, ("]}".includes(event.key) ? 1 : -1) * KEY_STEP * large);
    else if (event.key === "Delete") this.tell("tlkey", { key: "delete", path: box.path });
    else if (event.key.toLowerCase() === "d") this.tell("tlkey", { key: "duplicate", path: box.path });
    else if (event.key === "Enter" || event.key === " ") this.tell("tlkey", { key: "edit", path: box.path });
    else done = false;
    if (done) event.preventDefault();
  }

  nudge(box, sign) {
    if (box.moves === "time") this.tell("tlshift", { path: box.path, seconds: sign * KEY_STEP });
    else this.tell("tlkey", { key: sign > 0 ? "later" : "sooner", path: box.path });
  }

  longer(box, by) {
    const former = box.end - box.begin;
    this.tell("tlstretch", { path: box.path, former, seconds: Math.max(former + by, 0) });
  }

  step(by) {
    const numbers = (path) => path.split(".").map(Number);
    const before = (a, b) => {
      const [left, right] = [numbers(a), numbers(b)];
      for (let i = 0; i < Math.max(left.length, right.length); i++) {
        const difference = (left[i] ?? -1) - (right[i] ?? -1);
        if (difference) return difference;
      }
      return 0;
    };
    const paths = this.tracks.boxes.map((box) => box.path).sort(before);
    const next = paths[Math.min(Math.max(paths.indexOf(this.selected) + by, 0), paths.length - 1)];
    if (!next || !this.groups.has(next)) return;
    this.choose(next);
    this.groups.get(next).focus();
    this.groups.get(next).scrollIntoView({ block: "nearest", inline: "nearest" });
  }
}

function view(id) {
  const container = document.getElementById(id);
  if (!container) return null;
  let known = views.get(id);
  if (!known || known.container !== container) {
    known = new View(container);
    views.set(id, known);
  }
  return known;
}

export const show = (id, tracks, selected, whole) => view(id)?.show(tracks, selected, whole);
export const mark = (id, states, at) => { const known = view(id); if (known?.line) known.mark(states, at); };
export const zoom = (id, factor) => { const known = view(id); if (known) { if (factor) known.zoom(factor); else known.fit(); } };
