// One WebSocket a robot for everything live on a page: pose, lights, samples. See console/view/live_view.py for the frames.

const POSE = 1, LIGHTS = 2, SAMPLES = 3, PICTURE = 4;
const FIRST_RETRY = 500, LONGEST_RETRY = 8000; // ms

export function socketAddress(path, query) {
  const address = new URL(path, location.href);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  for (const [name, value] of Object.entries(query)) address.searchParams.set(name, value);
  return address;
}

// A WebSocket that comes back. `onState` gets true and false.
export class Socket {
  constructor(path, query, onMessage, onState) {
    this.path = path;
    this.query = query;
    this.onMessage = onMessage;
    this.onState = onState;
    this.retry = FIRST_RETRY;
    this.open();
  }

  open() {
    const socket = new WebSocket(socketAddress(this.path, this.query));
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.retry = FIRST_RETRY;
      this.onState(true, "");
    };
    socket.onmessage = (event) => this.onMessage(event.data);
    socket.onclose = (event) => {
      if (this.closed) return;
      this.onState(false, event.reason);
      this.timer = setTimeout(() => this.open(), this.retry);
      this.retry = Math.min(2 * this.retry, LONGEST_RETRY);
    };
    this.socket = socket;
  }

  send(value) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(value));
  }

  close() {
    this.closed = true;
    clearTimeout(this.timer);
    this.socket.close();
  }
}

const streams = new Map();

// The live stream of a robot. Events: layout, pose, lights, touched, shapes, traces, samples, state.
export class LiveStream extends EventTarget {
  static of(robot) {
    if (!streams.has(robot)) streams.set(robot, new LiveStream(robot));
    const stream = streams.get(robot);
    stream.users += 1;
    return stream;
  }

  constructor(robot) {
    super();
    this.robot = robot;
    this.users = 0;
    this.latest = new Map();
    this.wanted = new Map(); // trace -> how many want it
    this.socket = new Socket("/console/live", { robot }, (data) => this.receive(data), (open, reason) => {
      this.tell("state", { open, reason });
      if (open) this.sendWanted();
    });
  }

  release() {
    this.users -= 1;
    if (this.users > 0) return;
    this.socket.close();
    streams.delete(this.robot);
  }

  // What was told of a kind last, for one who comes later.
  last(kind) {
    return this.latest.get(kind);
  }

  want(trace) {
    this.wanted.set(trace, (this.wanted.get(trace) || 0) + 1);
    this.sendWanted();
  }

  leave(trace) {
    const count = (this.wanted.get(trace) || 1) - 1;
    if (count) this.wanted.set(trace, count);
    else this.wanted.delete(trace);
    this.sendWanted();
  }

  sendWanted() {
    this.socket.send({ watch: [...this.wanted.keys()] });
  }

  receive(data) {
    if (typeof data === "string") {
      const message = JSON.parse(data);
      this.tell(message.kind, message);
      return;
    }
    const view = new DataView(data);
    const kind = view.getUint8(0), count = view.getUint16(2, true);
    if (kind === POSE) {
      const base = Array.from({ length: 7 }, (_, i) => view.getFloat32(4 + 4 * i, true));
      this.tell("pose", {
        placed: (view.getUint8(1) & 1) === 1,
        place: base.slice(0, 3),
        turn: base.slice(3),
        stamp: view.getFloat64(32, true),
        joints: Float32Array.from({ length: count }, (_, i) => view.getFloat32(40 + 4 * i, true)),
      });
    } else if (kind === LIGHTS) {
      this.tell("lights", { colors: new Uint8Array(data, 4, 3 * count) });
    } else if (kind === SAMPLES) {
      const samples = [];
      for (let i = 0; i < count; i++) {
        const at = 4 + 16 * i;
        samples.push([view.getUint32(at, true), view.getFloat32(at + 4, true), view.getFloat64(at + 8, true)]);
      }
      this.tell("samples", { samples });
    }
  }

  tell(kind, detail) {
    this.latest.set(kind, detail);
    this.dispatchEvent(new CustomEvent(kind, { detail }));
  }
}

// A picture of a camera from its frame: { stamp, blob }.
export function readPicture(data) {
  const view = new DataView(data);
  if (view.getUint8(0) !== PICTURE) return null;
  const type = view.getUint8(1) === 1 ? "image/png" : "image/jpeg";
  return { stamp: view.getFloat64(8, true), blob: new Blob([new Uint8Array(data, 16)], { type }) };
}

export function isDark() {
  return document.body.classList.contains("body--dark");
}

// Calls `changed` whenever the page goes dark or light; returns what ends that.
export function watchTheme(changed) {
  const observer = new MutationObserver(changed);
  observer.observe(document.body, { attributes: true, attributeFilter: ["class"] });
  return () => observer.disconnect();
}
