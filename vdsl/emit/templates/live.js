// What was chosen and is there no more (vdsc explain VDS311).
const LOST = ["VDS311", "VDS312"];
const nameOf = (path) => (path || "").split("/").pop();

/** Where something is wrong: the file is named where it is not the script. */
function placeOf(one) {
  const file = nameOf(one.file);
  return `${one.severity}, ${file && file !== nameOf(board.source) ? `${file}, ` : ""}line ${one.line}`;
}

// Served by `vdsc serve`: choosing, and going along with what is compiled. From disk nothing of this runs.
const live = {
  token: document.querySelector('meta[name="vds-token"]').content,
  build: null,
  get served() { return Boolean(this.token); },

  async send(path, body) {
    const answer = await fetch(path, {
      method: "POST",
      headers: { "Content-Type": "application/json", "X-VDS-Token": this.token },
      body: JSON.stringify(body),
    });
    const told = await answer.json().catch(() => ({}));
    if (!answer.ok) throw new Error(told.error || `the server says ${answer.status}`);
    return told;
  },

  async change(path, body, words) {
    try {
      this.take((await this.send(path, body)).choices);
      by("pick-said").textContent = words;
    } catch (error) {
      by("pick-said").textContent = `Not written: ${error.message}`;
    }
  },

  choose(shot, take) {
    return this.change("/choose", { shot: shot.id, take: take.key },
      `Take ${take.rank} is kept; it is in the film after the next compile.`);
  },
  unchoose(shot) {
    return this.change("/unchoose", { shot: shot.id }, "The ranking decides again, from the next compile on.");
  },

  async further(shot) {
    try {
      this.drawn((await this.send("/further", { shot: shot.id })).further);
    } catch (error) {
      tellMore(shot, "error", [`No more takes: ${error.message}.`]);
    }
  },

  /** What is being drawn: {shot: {state, message}}; what was told of other shots is over, but for mistakes. */
  drawn(further) {
    for (const panel of panels) {
      const one = further[panel.dataset.shot];
      const busy = one && (one.state === "drawing" || one.state === "waiting");
      if (one) tellMore(shotOf(panel), one.state, [busy ? `More takes: ${one.message} …` : one.state === "error" ? `No more takes: ${one.message}.` : one.message]);
      else if (panel.querySelector('.further[aria-disabled="true"]')) tellMore(shotOf(panel), "", []);
    }
  },

  take(chosen) {
    choices.clear();
    for (const [shot, key] of Object.entries(chosen)) choices.set(shot, key);
    markChoices();
  },

  /** What the server tells: the build it has, what is being made, what is wrong with the script. */
  hear(state) {
    if (this.build !== null && state.build !== this.build) { this.again(); return; }
    this.build = state.build;
    this.take(state.choices);
    this.drawn(state.further);
    this.say(state);
  },

  say({ state, message, diagnostics, stale }) {
    const box = by("told");
    const wrong = state === "error";
    const words = wrong ? message || "The script has errors; this is the last good build."
      : state === "draft" || state === "firsts" ? message || "Drafting…" : state === "building" ? message || "Compiling…"
      : stale ? "The script has changed since this build." : "";
    const lost = diagnostics.filter((one) => LOST.includes(one.code));
    const found = wrong ? diagnostics : lost;
    const text = JSON.stringify([words, found]);
    if (box.dataset.text === text) return;
    box.dataset.text = text;
    box.hidden = !words && !found.length;
    box.classList.toggle("wrong", wrong);
    box.replaceChildren(make("p", {}, words), make("ul", {}, ...found.map((one) => make("li", {},
      make("p", {}, make("span", { class: "where" }, placeOf(one)), ` ${one.title || ""}`),
      make("p", {}, one.message || "", one.suggestion ? `; did you mean \`${one.suggestion}\`?` : ""), one.help ? make("p", { class: "soft small" }, one.help) : ""))));
  },

  /** Loads the page anew where it was: what is open, at which frame, and what is looked for. */
  again() {
    const seen = panels.find((panel) => panel.getBoundingClientRect().bottom > 80);
    sessionStorage.setItem("vds.back", JSON.stringify({
      y: scrollY, seen: seen?.dataset.shot, top: seen?.getBoundingClientRect().top, shot: viewer.isOpen ? viewer.shot.id : null, take: viewer.take?.key, said: by("pick-said").textContent, frame: viewer.isOpen ? viewer.frame : 0,
      playing: viewer.isOpen && !viewer.video.paused,
      filters: [...new FormData(filters)], at: at?.dataset.shot, film: film && !film.paused ? null : film?.currentTime,
      open: panels.filter((panel) => !panel.querySelector(".rest")).map((panel) => panel.dataset.shot),
    }));
    history.scrollRestoration = "manual";
    location.reload();
  },

  back() {
    const kept = JSON.parse(sessionStorage.getItem("vds.back") || "null");
    sessionStorage.removeItem("vds.back");
    history.scrollRestoration = "auto";
    if (!kept) return;
    for (const [name, value] of kept.filters) if (filters.elements[name]) filters.elements[name].value = value;
    look();
    for (const panel of panels) if (kept.open.includes(panel.dataset.shot)) showRest(panel);
    const seen = panels.find((p) => p.dataset.shot === kept.seen);
    const shift = seen && kept.y > 40 ? seen.getBoundingClientRect().top + scrollY - kept.top : kept.y;
    scrollTo({ top: shift, behavior: "instant" });
    const panel = panels.find((p) => p.dataset.shot === kept.at);
    if (panel) select(panel, false);
    if (film && kept.film) film.currentTime = kept.film;
    const shot = shots.get(kept.shot);
    if (!shot) return;
    // takes change places where one is chosen: what was open is known by its key
    const take = shot.takes.find((t) => t.key === kept.take);
    viewer.open(shot, take, kept.playing);
    if (take) by("pick-said").textContent = take.chosen && kept.said ? "This take is in the film." : kept.said;
    if (!kept.playing) viewer.video.addEventListener("loadedmetadata", () => viewer.seek(kept.frame), { once: true });
  },
};

if (live.served) {
  by("served").hidden = false;
  live.back();
  new EventSource("/events").addEventListener("state", (event) => live.hear(JSON.parse(event.data)));
}
