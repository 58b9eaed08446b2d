// <nao-robot-view robot="/" touchable>: the robot as it stands, from its description, with lights, footprint, ground and
// the things of a simulated world. A click on a touch sensor is an event `nao-touch` with detail {device}.

import { OrbitControls, STLLoader, THREE } from "nicegui-scene";
import { LiveStream, isDark, watchTheme } from "./live.js";

const LOOKS = {
  light: { sky: 0xf4f6f8, grid: 0xb8c0c8, middle: 0x7f8a94 },
  dark: { sky: 0x14181c, grid: 0x39424a, middle: 0x5f6a74 },
};
const FEET = ["l_sole", "r_sole"];
const OFF = new THREE.Color(0.3, 0.31, 0.33);
const TOUCH_RADIUS = 0.014; // m
const SLOW = 50; // ms that a picture takes without a graphics processor
const STYLE = `
:host { display: block; position: relative; height: 420px; border-radius: 6px; overflow: hidden; }
canvas { display: block; width: 100%; height: 100%; touch-action: none; }
canvas:focus-visible { outline: 3px solid #5898d4; outline-offset: -3px; }
p { position: absolute; left: 8px; bottom: 6px; margin: 0; padding: 2px 8px; border-radius: 4px; color: #fff;
  background: rgba(0, 0, 0, 0.65); font: 13px sans-serif; pointer-events: none; }
p:empty { display: none; }
`;

function placed(object, xyz, rpy) {
  object.position.set(...xyz);
  object.quaternion.setFromEuler(new THREE.Euler(rpy[0], rpy[1], rpy[2], "ZYX"));
  return object;
}

function colored(color) {
  const [red, green, blue, alpha = 1] = color;
  return new THREE.MeshStandardMaterial({
    color: new THREE.Color().setRGB(red, green, blue, THREE.SRGBColorSpace),
    roughness: 0.55, opacity: alpha, transparent: alpha < 1,
  });
}

function alongZ(radius, length) {
  return new THREE.CylinderGeometry(radius, radius, length, 24).rotateX(Math.PI / 2);
}

// Lines every 0.25 m, cell by cell: some software renderers lose a line whose end is behind the camera.
function makeGrid(look) {
  const points = [], colors = [], usual = new THREE.Color(look.grid), middle = new THREE.Color(look.middle);
  const cells = 20, size = 0.25;
  for (let i = -cells; i <= cells; i++) {
    const color = i === 0 ? middle : usual;
    for (let j = -cells; j < cells; j++) {
      points.push(i * size, j * size, 0, i * size, (j + 1) * size, 0, j * size, i * size, 0, (j + 1) * size, i * size, 0);
      for (let end = 0; end < 4; end++) colors.push(color.r, color.g, color.b);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colors, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true }));
}

class NaoRobotView extends HTMLElement {
  static observedAttributes = ["touchable"];

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    const style = document.createElement("style");
    style.textContent = STYLE;
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "the robot in three dimensions; arrow keys turn it, plus and minus zoom");
    this.note = document.createElement("p");
    root.append(style, this.canvas, this.note);
  }

  connectedCallback() {
    this.name = this.getAttribute("robot") || "/";
    this.meshes = new Map();
    this.joints = new Map();
    this.mimics = [];
    this.lights = new Map();
    this.spots = [];
    this.prepare();
    this.stream = LiveStream.of(this.name);
    this.listeners = {
      layout: () => this.onPose(), pose: () => this.onPose(), lights: () => this.onLights(),
      touched: (event) => this.onTouched(event.detail), shapes: (event) => this.onShapes(event.detail),
      state: (event) => this.say(event.detail.open ? "" : event.detail.reason || "no connection to the console"),
    };
    for (const [kind, listener] of Object.entries(this.listeners)) this.stream.addEventListener(kind, listener);
    this.load();
  }

  disconnectedCallback() {
    cancelAnimationFrame(this.frame);
    this.sizes.disconnect();
    this.endTheme();
    for (const [kind, listener] of Object.entries(this.listeners)) this.stream.removeEventListener(kind, listener);
    this.stream.release();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  attributeChangedCallback() {
    for (const spot of this.spots || []) spot.visible = this.canTouch;
    this.dirty = true;
  }

  get canTouch() {
    return this.hasAttribute("touchable") && this.getAttribute("touchable") !== "false";
  }

  say(text) {
    this.note.textContent = text;
  }

  prepare() {
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true });
    } catch {
      this.say("this browser draws nothing in three dimensions (WebGL)");
      throw new Error("no WebGL");
    }
    this.gl = this.renderer.getContext();
    this.scene = new THREE.Scene();
    this.eye = new THREE.PerspectiveCamera(40, 1, 0.02, 60);
    this.eye.up.set(0, 0, 1);
    this.eye.position.set(1.05, 0.75, 0.6);
    this.controls = new OrbitControls(this.eye, this.canvas);
    this.controls.target.set(0, 0, 0.28);
    this.controls.addEventListener("change", () => (this.dirty = true));
    this.controls.update();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.8);
    sun.position.set(2, 1.5, 3);
    this.scene.add(sun);
    this.base = new THREE.Group();
    this.things = new THREE.Group();
    this.footprint = this.makeFootprint();
    this.scene.add(this.base, this.things, this.footprint);
    this.recolor();
    this.endTheme = watchTheme(() => this.recolor());
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(this);
    this.resize();
    this.canvas.addEventListener("pointermove", (event) => this.hover(event));
    this.canvas.addEventListener("pointerdown", (event) => (this.down = [event.clientX, event.clientY]));
    this.canvas.addEventListener("click", (event) => this.click(event));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    this.restsUntil = 0;
    const draw = () => {
      this.frame = requestAnimationFrame(draw);
      if (!this.dirty || !this.isDrawn() || performance.now() < this.restsUntil) return;
      this.dirty = false;
      this.renderer.render(this.scene, this.eye);
      this.began = performance.now();
      this.drawing = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      this.gl.flush();
    };
    draw();
  }

  // Without a graphics processor a picture takes long after the call that draws it. Pictures that queued up would hold
  // up the page, and its connection would break: none is begun before the last is there, and behind a slow one is a rest.
  isDrawn() {
    if (!this.drawing) return true;
    if (this.gl.getSyncParameter(this.drawing, this.gl.SYNC_STATUS) !== this.gl.SIGNALED && !this.gl.isContextLost()) return false;
    this.gl.deleteSync(this.drawing);
    this.drawing = null;
    const took = performance.now() - this.began;
    if (took > SLOW) this.restsUntil = performance.now() + 2 * took;
    return true;
  }

  recolor() {
    const look = isDark() ? LOOKS.dark : LOOKS.light;
    this.scene.background = new THREE.Color(look.sky);
    if (this.grid) {
      this.scene.remove(this.grid);
      this.grid.geometry.dispose();
    }
    this.grid = makeGrid(look);
    this.scene.add(this.grid);
    this.dirty = true;
  }

  makeFootprint() {
    const group = new THREE.Group();
    const ring = new THREE.Mesh(new THREE.RingGeometry(0.115, 0.122, 48),
      new THREE.MeshBasicMaterial({ color: 0x2e7d32, side: THREE.DoubleSide }));
    const arrow = new THREE.ArrowHelper(new THREE.Vector3(1, 0, 0), new THREE.Vector3(), 0.18, 0x2e7d32, 0.04, 0.03);
    group.add(ring, arrow);
    group.visible = false;
    return group;
  }

  resize() {
    const width = this.clientWidth || 1, height = this.clientHeight || 1;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    this.eye.aspect = width / height;
    this.eye.updateProjectionMatrix();
    this.dirty = true;
  }

  async load() {
    this.say("reads the robot's description");
    try {
      const answer = await fetch(`/console/model?robot=${encodeURIComponent(this.name)}`);
      if (!answer.ok) throw new Error((await answer.text()).slice(0, 300));
      await this.build(await answer.json());
    } catch (error) {
      this.say(`no picture of the robot: ${error.message}`);
      if (this.isConnected) setTimeout(() => this.isConnected && !this.links && this.load(), 3000);
    }
  }

  async build(model) {
    const addresses = new Set(Object.values(model.links).flat().map((visual) => visual.mesh).filter(Boolean));
    const loader = new STLLoader();
    await Promise.all([...addresses].map(async (mesh) => {
      this.meshes.set(mesh, await loader.loadAsync(`/console/meshes/${mesh.split("/").map(encodeURIComponent).join("/")}`));
    }));
    this.links = new Map(Object.keys(model.links).map((name) => [name, new THREE.Group()]));
    for (const [name, visuals] of Object.entries(model.links)) {
      for (const visual of visuals) this.links.get(name).add(this.shape(visual, model.lights[name]));
    }
    for (const joint of model.joints) {
      const turn = placed(new THREE.Group(), joint.xyz, joint.rpy), moved = new THREE.Group();
      turn.add(moved);
      moved.add(this.links.get(joint.child));
      this.links.get(joint.parent).add(turn);
      const axis = new THREE.Vector3(...joint.axis).normalize();
      if (joint.kind !== "fixed") this.joints.set(joint.name, { moved, axis, slides: joint.kind === "prismatic" });
      if (joint.mimic) this.mimics.push([joint.name, ...joint.mimic]);
    }
    for (const [link, device] of Object.entries(model.touch)) this.addSpot(this.links.get(link), device);
    this.base.add(this.links.get(model.root));
    this.say(model.left_out.length ? `${model.left_out.length} meshes of kinds that are not drawn` : "");
    this.onPose();
    this.onLights();
    this.dispatchEvent(new CustomEvent("nao-ready", { bubbles: true }));
  }

  shape(visual, light) {
    let geometry;
    if (visual.kind === "box") geometry = new THREE.BoxGeometry(...visual.size);
    else if (visual.kind === "sphere") geometry = new THREE.SphereGeometry(visual.size[0], 24, 16);
    else if (visual.kind === "cylinder") geometry = alongZ(...visual.size);
    else geometry = this.meshes.get(visual.mesh);
    const material = light ? new THREE.MeshBasicMaterial({ color: OFF }) : colored(visual.color);
    const mesh = placed(new THREE.Mesh(geometry, material), visual.xyz, visual.rpy);
    if (visual.kind === "mesh") mesh.scale.set(...visual.size);
    if (light) this.lights.set(light, [...(this.lights.get(light) || []), material]);
    return mesh;
  }

  addSpot(link, device) {
    const material = new THREE.MeshBasicMaterial({ color: 0xffb300, transparent: true, opacity: 0.35, depthTest: false });
    const spot = new THREE.Mesh(new THREE.SphereGeometry(TOUCH_RADIUS, 16, 12), material);
    spot.renderOrder = 2;
    spot.visible = this.canTouch;
    spot.userData.device = device;
    this.spots.push(spot);
    link.add(spot);
  }

  onPose() {
    const layout = this.stream.last("layout"), pose = this.stream.last("pose");
    if (!this.links || !layout || !pose) return;
    const angles = new Map(layout.joints.map((name, i) => [name, pose.joints[i]]));
    for (const [name, leader, factor, offset] of this.mimics) {
      if (angles.has(leader)) angles.set(name, factor * angles.get(leader) + offset);
    }
    for (const [name, angle] of angles) {
      const joint = this.joints.get(name);
      if (!joint || !Number.isFinite(angle)) continue;
      if (joint.slides) joint.moved.position.copy(joint.axis).multiplyScalar(angle);
      else joint.moved.quaternion.setFromAxisAngle(joint.axis, angle);
    }
    if (pose.placed) {
      this.base.position.set(...pose.place);
      this.base.quaternion.set(...pose.turn);
    } else {
      this.base.position.set(0, 0, 0);
      this.base.quaternion.identity();
    }
    this.base.updateMatrixWorld(true);
    this.showFootprint(pose.placed);
    this.follow();
    this.dirty = true;
  }

  // Between the soles, at the lower one, with their mean heading (REP 120).
  showFootprint(known) {
    const feet = FEET.map((name) => this.links.get(name));
    if (feet.some((foot) => !foot)) return;
    const places = feet.map((foot) => foot.getWorldPosition(new THREE.Vector3()));
    const low = Math.min(places[0].z, places[1].z);
    if (!known) {
      this.base.position.z -= low;
      this.base.updateMatrixWorld(true);
      for (const place of places) place.z -= low;
    }
    const heading = feet.map((foot) => new THREE.Vector3(1, 0, 0).transformDirection(foot.matrixWorld));
    const ahead = heading[0].add(heading[1]);
    this.footprint.position.set((places[0].x + places[1].x) / 2, (places[0].y + places[1].y) / 2,
      (known ? low : 0) + 0.002);
    this.footprint.rotation.z = Math.atan2(ahead.y, ahead.x);
    this.footprint.visible = true;
  }

  // The view goes where the robot goes.
  follow() {
    const at = this.base.position, target = this.controls.target;
    const way = new THREE.Vector3(at.x - target.x, at.y - target.y, 0);
    if (way.length() < 0.02) return;
    this.eye.position.add(way);
    target.add(way);
    this.controls.update();
  }

  onLights() {
    const layout = this.stream.last("layout"), lights = this.stream.last("lights");
    if (!layout || !lights) return;
    layout.lights.forEach((name, i) => {
      const parts = [...lights.colors.slice(3 * i, 3 * i + 3)].map((part) => part / 255);
      for (const material of this.lights.get(name) || []) {
        if (Math.max(...parts) < 0.02) material.color.copy(OFF);
        else material.color.setRGB(...parts, THREE.SRGBColorSpace);
      }
    });
    this.dirty = true;
  }

  onTouched({ devices }) {
    for (const spot of this.spots) {
      const touched = devices.includes(spot.userData.device);
      spot.material.color.set(touched ? 0xe53935 : 0xffb300);
      spot.material.opacity = touched ? 0.9 : 0.35;
      spot.visible = touched || this.canTouch;
      spot.userData.touched = touched;
    }
    this.dirty = true;
  }

  onShapes({ shapes }) {
    this.things.traverse((object) => object.geometry && object.geometry.dispose());
    this.things.clear();
    for (const shape of shapes) {
      const [a, b, c] = shape.size;
      let geometry;
      if (shape.form === "box" || shape.form === "pillow") geometry = new THREE.BoxGeometry(a, b, c);
      else if (shape.form === "cylinder") geometry = alongZ(a, b);
      else if (shape.form === "capsule") geometry = new THREE.CapsuleGeometry(a, b, 8, 20).rotateX(Math.PI / 2);
      else if (shape.form === "ellipsoid") geometry = new THREE.SphereGeometry(1, 24, 16).scale(a, b, c);
      else if (shape.form === "sphere") geometry = new THREE.SphereGeometry(a, 24, 16);
      else continue;
      const mesh = new THREE.Mesh(geometry, colored(shape.color));
      mesh.position.set(...shape.place);
      mesh.quaternion.set(...shape.turn);
      this.things.add(mesh);
    }
    this.dirty = true;
  }

  hit(event) {
    if (!this.canTouch) return null;
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.eye);
    const [first] = ray.intersectObjects(this.spots.filter((spot) => spot.visible), false);
    return first ? first.object.userData.device : null;
  }

  hover(event) {
    if (event.buttons || !this.links) return;
    const device = this.hit(event);
    this.canvas.style.cursor = device ? "pointer" : "grab";
    this.canvas.title = device || "";
  }

  click(event) {
    if (this.down && Math.hypot(event.clientX - this.down[0], event.clientY - this.down[1]) > 6) return; // it was turned
    const device = this.hit(event);
    if (device) this.dispatchEvent(new CustomEvent("nao-touch", { detail: { device }, bubbles: true, composed: true }));
  }

  key(event) {
    const offset = this.eye.position.clone().sub(this.controls.target);
    const way = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    const change = { ArrowLeft: [-0.12, 0, 1], ArrowRight: [0.12, 0, 1], ArrowUp: [0, -0.1, 1], ArrowDown: [0, 0.1, 1],
      "+": [0, 0, 0.9], "-": [0, 0, 1.1] }[event.key];
    if (!change) return;
    event.preventDefault();
    event.stopPropagation();
    way.theta += change[0];
    way.phi = Math.min(Math.max(way.phi + change[1], 0.05), Math.PI - 0.05);
    way.radius = Math.min(Math.max(way.radius * change[2], 0.2), 20);
    const turned = new THREE.Vector3().setFromSpherical(way);
    this.eye.position.copy(this.controls.target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    this.controls.update();
    this.dirty = true;
  }
}

if (!customElements.get("nao-robot-view")) customElements.define("nao-robot-view", NaoRobotView);
