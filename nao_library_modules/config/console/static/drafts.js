// <nao-draft editor draft saved revision>: keeps in this browser what was typed into an editor and is not saved, and offers it
// when the editor is opened again. `editor`: NiceGUI's id of the element; `draft`: whose and of what; `saved`: the text that
// needs no draft, `revision`: what tells it from another; `text`: what the editor has while it is not drawn.
// The event nao-draft-shown has the text of the draft that is wanted, and its revision.

const PERIOD = 200; // ms between two looks
const KEPT = 30 * 24 * 3600 * 1000; // ms
const LONGEST_SHOWN = 60; // characters of a draft of one line
const plain = (text) => (text ?? "").replace(/\r\n?/g, "\n");

class Draft extends HTMLElement {
  static observedAttributes = ["draft", "saved", "revision"];

  connectedCallback() {
    this.role = "status";
    this.clock = setInterval(() => this.look(), PERIOD);
    this.leave = () => this.look();
    window.addEventListener("pagehide", this.leave);
    this.begin();
  }

  disconnectedCallback() {
    this.look();
    clearInterval(this.clock);
    window.removeEventListener("pagehide", this.leave);
  }

  attributeChangedCallback(name) {
    if (!this.isConnected) return;
    this.other ||= name === "draft";
    this.last = this.wanted = null;
    queueMicrotask(() => this.other && this.begin()); // the others change with it
  }

  get prefix() {
    return `nao-draft ${this.getAttribute("draft")} `;
  }

  // Another text: what is kept of the one before is offered when that is opened again.
  begin() {
    this.own = this.prefix + crypto.getRandomValues(new Uint32Array(2)).join("-");
    this.other = false;
    this.last = this.wanted = null;
    this.offer();
  }

  // not `text`: Vue sets attributes as properties where an element has one of the name
  current() {
    const id = this.getAttribute("editor");
    this.view = getElement(id)?.editor ?? this.view;
    if (this.view) {
      if (this.view.state.doc !== this.doc) [this.doc, this.typed] = [this.view.state.doc, this.view.state.doc.toString()];
      return this.typed;
    }
    const shown = document.getElementById(`c${id}`);
    this.field = (shown?.matches("input, textarea") ? shown : shown?.querySelector("input, textarea")) ?? this.field;
    return plain(this.field ? this.field.value : this.getAttribute("text") ?? this.getAttribute("saved"));
  }

  look() {
    const text = this.current();
    if (text === this.last || !this.getAttribute("draft")) return;
    this.last = text;
    if (text === plain(this.getAttribute("saved"))) {
      localStorage.removeItem(this.own);
      return;
    }
    try {
      const kept = { text, revision: this.getAttribute("revision"), time: Date.now() };
      localStorage.setItem(this.own, JSON.stringify(this.wanted ? { ...kept, revision: this.wanted.revision } : kept));
    } catch (error) {
      this.replaceChildren(`This browser does not keep what you type until it is saved: ${error.message}`);
      return;
    }
    if (this.wanted?.text === text) {
      localStorage.removeItem(this.wanted.name);
      this.offer();
    }
  }

  drafts() {
    const names = Object.keys(localStorage).filter((name) => name.startsWith(this.prefix) && name !== this.own);
    const found = names.map((name) => ({ name, ...JSON.parse(localStorage.getItem(name)) }));
    const saved = plain(this.getAttribute("saved"));
    const over = found.filter(({ text, time }) => text === saved || Date.now() - time > KEPT);
    over.forEach(({ name }) => localStorage.removeItem(name));
    return found.filter((draft) => !over.includes(draft)).sort((one, other) => other.time - one.time);
  }

  offer() {
    this.replaceChildren(...this.drafts().map((draft) => this.line(draft)));
  }

  line(draft) {
    const line = document.createElement("p");
    const short = draft.text.includes("\n") ? "" : `: “${draft.text.slice(0, LONGEST_SHOWN)}”`;
    const changed = draft.revision === this.getAttribute("revision")
      ? "" : " What is saved has changed since then: to save the draft undoes that change.";
    line.append(`A draft of ${new Date(draft.time).toLocaleString("en-GB")} is not saved${short}.${changed}`);
    const choices = { "Show the draft": () => this.show(draft), "Throw it away": () => this.drop(draft) };
    for (const [text, act] of Object.entries(choices)) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = text;
      button.addEventListener("click", act);
      line.append(button);
    }
    return line;
  }

  show(draft) {
    this.wanted = draft; // it goes when the editor has it
    const { text, revision } = draft;
    this.dispatchEvent(new CustomEvent("nao-draft-shown", { detail: { text, revision } }));
  }

  drop({ name }) {
    localStorage.removeItem(name);
    this.offer();
  }
}

if (!customElements.get("nao-draft")) customElements.define("nao-draft", Draft);
