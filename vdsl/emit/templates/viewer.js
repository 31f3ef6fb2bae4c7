// The viewing room: one take large, frame by frame, with what was measured of it.
const board = JSON.parse(document.getElementById("data").textContent);
const fps = board.fps[0] / board.fps[1];
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const by = (id) => document.getElementById(id);
const said = (name) => name.replaceAll("_", " ");

/** An element with attributes and children; text is always text. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) if (value !== false) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** A word as a shell takes it. */
function quoted(word) {
  return /^[\w@%+=:,./-]+$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
}

/** What is chosen: shot id to the take's key. From disk as the build has it, served as the lock has it now. */
const choices = new Map();
for (const shot of board.shots) for (const take of shot.takes) if (take.chosen) choices.set(shot.id, take.key);

const viewer = {
  box: by("viewer"),
  video: by("player"),
  shot: null,
  take: null,

  get isOpen() { return this.box.open; },
  get frames() { return this.take.frames; },
  get frame() { return Math.min(this.frames - 1, Math.max(0, Math.floor(this.video.currentTime * fps + 0.01))); },

  open(shot, take, playing = true) {
    if (!shot || !shot.takes.length) return;
    this.show(shot, take || shot.takes[0]);
    if (!this.isOpen) this.box.showModal();
    if (playing && !calm.matches) this.play();
  },

  close() { this.box.close(); },

  show(shot, take) {
    const playing = this.isOpen && !this.video.paused;
    const same = this.shot === shot;
    this.shot = shot;
    this.take = take;
    by("pick-said").textContent = "";
    this.video.poster = take.poster;
    if (take.video) this.video.src = take.video;
    else { this.video.removeAttribute("src"); this.video.load(); }
    this.box.classList.toggle("sketched", !take.video);
    by("scrub").max = take.frames - 1;
    by("scrub").value = 0;
    this.tell();
    if (!same) this.fillStrip();
    this.markTake();
    this.told();
    if (playing) this.play();
    document.dispatchEvent(new CustomEvent("shown", { detail: { shot, take } }));
  },

  fillStrip() {
    by("takes").replaceChildren(...this.shot.takes.map((take) => {
      const picture = make("img", { src: take.poster, alt: "" });
      const button = make("button", { type: "button", "aria-label": `Take ${take.rank}, score ${take.score}` },
        picture, make("i", { "aria-hidden": "true" }, String(take.rank)));
      button.addEventListener("click", () => this.show(this.shot, take));
      return button;
    }));
    if (panelOf(this.shot).querySelector(".further")) {
      const more = make("button", { type: "button", class: "further", "aria-label": "Draw more takes", title: "Draw more takes" }, "more");
      more.addEventListener("click", () => askMore(this.shot));
      by("takes").append(more);
    }
    by("viewer-drawing").replaceChildren(...[...panelOf(this.shot).querySelector(".drawing")?.childNodes || []].map((node) => node.cloneNode(true)));
  },

  markTake() {
    [...by("takes").querySelectorAll("button:not(.further)")].forEach((button, k) => {
      const take = this.shot.takes[k];
      button.setAttribute("aria-pressed", String(take === this.take));
      button.classList.toggle("chosen", choices.get(this.shot.id) === take.key);
    });
    by("takes").children[this.shot.takes.indexOf(this.take)]?.scrollIntoView?.({ block: "nearest", inline: "nearest" });
    const chosen = choices.get(this.shot.id) === this.take.key;
    by("pick-now").replaceChildren(chosen ? make("span", { class: "picked" }, "chosen") : "");
    by("command").textContent = `vdsc pick ${quoted(board.source)} ${quoted(this.shot.id)} ${this.take.rank}`;
    by("choose").hidden = !live.served || chosen;
    by("unchoose").hidden = !live.served || !choices.has(this.shot.id);
    by("choose").textContent = `Choose take ${this.take.rank}`;
    by("pick-copy").hidden = live.served;
  },

  told() {
    const { shot, take } = this;
    by("viewer-number").textContent = shot.n;
    by("viewer-text").textContent = shot.text;
    by("viewer-say").textContent = shot.say || "";
    by("viewer-say").hidden = !shot.say;
    by("viewer-note").textContent = shot.note || "";
    by("viewer-note").hidden = !shot.note;
    by("viewer-camera").textContent = take.camera;
    by("viewer-asked").textContent = `asked for: ${shot.asked}` + (take.became ? `; came out as ${take.became}` : "");
    by("viewer-score").textContent = take.score;
    by("viewer-rank").textContent = `take ${take.rank} of ${shot.takes.length}, ${take.length}, acted ${said(take.variant)}`
      + (take.video ? "" : "; a draft, its film is being made");
    by("viewer-why").textContent = take.why[0].toUpperCase() + take.why.slice(1) + ".";
    by("viewer-track").href = take.track;
    by("viewer-more").textContent = `${shot.takes.length} kept of ${shot.proposals} judged.`;
    const row = (measure) => make("li", {}, make("span", { class: "mark", "aria-hidden": "true" }, measure.fine ? "✓" : "✕"),
      make("span", {}, measure.fine ? "" : make("span", { class: "aside" }, "not so: "), measure.words),
      make("span", { class: "value" }, measure.value));
    const fine = take.measures.filter((measure) => measure.fine);
    by("off").replaceChildren(...take.measures.filter((measure) => !measure.fine).map(row));
    by("fine").replaceChildren(...fine.map(row));
    by("fine-count").textContent = fine.length === take.measures.length ? `All ${fine.length} are as they should be`
      : `${fine.length} are as they should be`;
    const plan = [...document.querySelectorAll("template[data-plan]")].find((t) => t.dataset.plan === shot.id && Number(t.dataset.take) === take.rank);
    by("viewer-plan").hidden = !plan;
    by("plan").replaceChildren(plan ? plan.content.cloneNode(true) : "");
  },

  tell() {
    const seconds = this.frame / fps;
    by("scrub").value = this.frame;
    by("scrub").setAttribute("aria-valuetext", `frame ${this.frame + 1} of ${this.frames}`);
    by("clock").replaceChildren(`${this.frame + 1}/${this.frames}`, make("span", { class: "seconds" }, ` · ${seconds.toFixed(2)} s`));
    by("play").textContent = this.video.paused ? "▶" : "❚❚";
    by("play").setAttribute("aria-label", this.video.paused ? "Play" : "Stop");
  },

  seek(frame) {
    this.video.pause();
    this.video.currentTime = (Math.min(this.frames - 1, Math.max(0, frame)) + 0.5) / fps;
  },

  play() { if (this.take.video) this.video.play().catch(() => {}); },
  toggle() { this.video.paused ? this.play() : this.video.pause(); },

  /** The next shot that has a take, and is shown. */
  turn(by) {
    const shots = shownShots().filter((shot) => shot.takes.length);
    const at = shots.indexOf(this.shot);
    const next = shots[at + by];
    if (next) this.show(next, next.takes[0]);
  },
};

{
  const { box, video } = viewer;
  const follow = () => { if (viewer.take) viewer.tell(); if (!video.paused) requestAnimationFrame(follow); };
  for (const name of ["play", "pause", "seeked", "loadedmetadata"]) video.addEventListener(name, follow);
  video.addEventListener("click", () => viewer.toggle());
  by("play").addEventListener("click", () => viewer.toggle());
  by("back").addEventListener("click", () => viewer.seek(viewer.frame - 1));
  by("forth").addEventListener("click", () => viewer.seek(viewer.frame + 1));
  by("scrub").addEventListener("input", (event) => viewer.seek(Number(event.target.value)));
  by("before").addEventListener("click", () => viewer.turn(-1));
  by("after").addEventListener("click", () => viewer.turn(1));
  by("close").addEventListener("click", () => viewer.close());
  by("choose").addEventListener("click", () => live.choose(viewer.shot, viewer.take));
  by("unchoose").addEventListener("click", () => live.unchoose(viewer.shot));
  by("copy").addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(by("command").textContent);
      by("pick-said").textContent = "Copied.";
    } catch {
      getSelection().selectAllChildren(by("command"));
      by("pick-said").textContent = "Marked; copy it with Ctrl+C or ⌘C.";
    }
  });
  box.addEventListener("close", () => { video.pause(); video.removeAttribute("src"); video.load(); panelOf(viewer.shot)?.querySelector(".frame").focus(); });
}
