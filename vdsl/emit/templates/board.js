// The board: panels that play, takes to step through, what is looked for, and the keys.
const panels = [...document.querySelectorAll(".panel")];
const shots = new Map(board.shots.map((shot) => [shot.id, shot]));
const shotOf = (panel) => shots.get(panel.dataset.shot);
const shownPanels = () => panels.filter((panel) => !panel.classList.contains("hidden"));
function shownShots() { return shownPanels().map(shotOf); }
const panelOf = (shot) => panels.find((panel) => panel.dataset.shot === shot.id);

// --- a panel: its picture, its takes ----------------------------------------------------------

const takeOf = new Map(board.shots.map((shot) => [shot.id, shot.takes[0]]));
const moving = make("video", { muted: "", loop: "", playsinline: "", "aria-hidden": "true" });
moving.muted = true;

function playIn(panel) {
  const take = takeOf.get(panel.dataset.shot);
  const frame = panel.querySelector(".frame");
  if (!take?.video || !frame) return;
  if (moving.parentElement !== frame) frame.querySelector("img").after(moving);
  if (moving.getAttribute("src") !== take.video) moving.src = take.video;
  moving.poster = take.poster;
  moving.play().catch(() => {});
}

function stop() {
  moving.pause();
  moving.remove();
}

function showTake(panel, rank) {
  const shot = shotOf(panel);
  const take = shot.takes.find((t) => t.rank === rank);
  if (!take) return;
  takeOf.set(shot.id, take);
  const frame = panel.querySelector(".frame");
  frame.href = take.video || take.poster;
  frame.querySelector("img").src = take.poster;
  frame.querySelector(".long").textContent = take.length;
  panel.querySelector(".camera").textContent = take.camera;
  panel.querySelector(".which").textContent =
    rank === 1 ? `${shot.chosen || shot.trade ? "chosen from" : "best of"} ${shot.proposals}` : `take ${rank}, score ${take.score}: ${take.why}`;
  for (const button of panel.querySelectorAll(".strip [data-take]")) {
    button.setAttribute("aria-pressed", String(Number(button.dataset.take) === rank));
    if (Number(button.dataset.take) === rank && button.hidden) showRest(panel);
  }
  if (moving.parentElement === frame) playIn(panel);
}

function showRest(panel) {
  for (const button of panel.querySelectorAll(".strip [hidden]")) button.hidden = false;
  panel.querySelector(".rest")?.remove();
}

// --- more takes than there are --------------------------------------------------------------------

const moreCommand = (shot) => `vdsc compile ${quoted(board.source)} --more ${quoted(shot.id)}`;

/** Served they are drawn; from disk the command is told that draws them. */
async function askMore(shot) {
  const panel = panelOf(shot);
  if (!panel.querySelector(".further")) return;
  showRest(panel);
  if (live.served) { await live.further(shot); return; }
  let copied = "";
  try { await navigator.clipboard.writeText(moreCommand(shot)); copied = " It is copied."; } catch { /* then it is marked by a click */ }
  tellMore(shot, "", ["More takes are drawn by ", make("code", {}, moreCommand(shot)), `.${copied}`]);
}

/** What is said of a shot's further takes, on the board and in the viewing room. */
function tellMore(shot, state, words) {
  const busy = state === "drawing" || state === "waiting";
  const box = panelOf(shot).querySelector(".drawing");
  const said = JSON.stringify([state, words.map((word) => word.textContent ?? word)]);
  if (box && box.dataset.said !== said) {
    box.dataset.said = said;
    box.hidden = !words.length;
    box.classList.toggle("wrong", state === "error");
    box.replaceChildren(...words);
  }
  panelOf(shot).querySelector(".further")?.setAttribute("aria-disabled", String(busy));
  if (viewer.shot === shot) by("viewer-drawing").replaceChildren(...words.map((word) => word.cloneNode?.(true) ?? word));
}

/** Rings the takes that are chosen, on the board and in the viewing room. */
function markChoices() {
  for (const panel of panels) {
    const shot = shotOf(panel);
    const chosen = choices.get(shot.id);
    for (const button of panel.querySelectorAll(".strip [data-take]")) {
      const take = shot.takes.find((t) => t.rank === Number(button.dataset.take));
      button.classList.toggle("chosen", chosen === take.key);
      const name = `Take ${take.rank}, score ${take.score}`;
      button.setAttribute("aria-label", chosen === take.key ? `${name}, chosen` : name);
    }
    const frame = panel.querySelector(".frame");
    frame?.querySelector(".picked")?.remove();
    if (frame && shot.takes.some((t) => t.key === chosen)) frame.append(make("span", { class: "picked" }, "chosen"));
  }
  if (viewer.isOpen) viewer.markTake();
}

for (const panel of panels) {
  const frame = panel.querySelector(".frame");
  frame?.addEventListener("click", (event) => {
    if (event.metaKey || event.ctrlKey || event.shiftKey) return;
    event.preventDefault();
    select(panel, false);
    viewer.open(shotOf(panel), takeOf.get(panel.dataset.shot));
  });
  frame?.addEventListener("pointerenter", (event) => { if (event.pointerType === "mouse" && !calm.matches) playIn(panel); });
  frame?.addEventListener("pointerleave", (event) => { if (event.pointerType === "mouse") stop(); });
  for (const button of panel.querySelectorAll(".strip [data-take]")) {
    button.addEventListener("click", () => { select(panel, false); showTake(panel, Number(button.dataset.take)); });
  }
  panel.querySelector(".rest")?.addEventListener("click", () => showRest(panel));
  const further = panel.querySelector(".further");
  if (further) further.hidden = false;
  further?.addEventListener("click", () => { select(panel, false); askMore(shotOf(panel)); });
}

// --- where one is -------------------------------------------------------------------------------

let at = null;
function select(panel, scrolling = true) {
  at?.classList.remove("at");
  at = panel;
  panel.classList.add("at");
  if (scrolling) {
    panel.scrollIntoView({ block: "nearest" });
    panel.querySelector(".frame")?.focus({ preventScroll: true });
  }
}
function move(by) {
  const list = shownPanels();
  const k = list.indexOf(at);
  const next = list[Math.min(list.length - 1, Math.max(0, k < 0 ? 0 : k + by))];
  if (next) select(next);
}
document.addEventListener("focusin", (event) => {
  const panel = event.target.closest?.(".panel");
  if (panel && panel !== at) select(panel, false);
});
document.addEventListener("shown", (event) => {
  const panel = panelOf(event.detail.shot);
  select(panel, false);
  showTake(panel, event.detail.take.rank);
});

// --- what is looked for ---------------------------------------------------------------------------

const filters = by("filters");
const folded = (text) => said(text).normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
const haystack = new Map(panels.map((panel) => [panel, folded(
  `${panel.querySelector(".words").textContent} ${panel.dataset.scene} ${shotOf(panel).takes.map((t) => t.camera).join(" ")}`)]));

function look() {
  const wanted = new FormData(filters);
  const words = folded(wanted.get("words") || "").split(/\s+/).filter(Boolean);
  const fits = (panel) => words.every((word) => haystack.get(panel).includes(word))
    && ["scene", "size", "angle", "move"].every((key) => !wanted.get(key) || panel.dataset[key] === wanted.get(key))
    && (!wanted.get("character") || panel.dataset.character.split(" ").includes(wanted.get("character")));
  for (const panel of panels) panel.classList.toggle("hidden", !fits(panel));
  for (const group of document.querySelectorAll(".group")) group.hidden = !group.querySelector(".panel:not(.hidden)");
  const count = shownPanels().length;
  const all = count === panels.length;
  by("found").textContent = all ? `${count} ${count === 1 ? "shot" : "shots"}` : `${count} of ${panels.length} shots`;
  by("nothing").hidden = count > 0 || !panels.length;
}
filters.addEventListener("input", look);
filters.addEventListener("submit", (event) => { event.preventDefault(); by("board").focus(); });
by("clear").addEventListener("click", () => { filters.reset(); look(); setPanels(); });
for (const button of document.querySelectorAll("[data-filter]")) {
  button.addEventListener("click", () => {
    filters.elements.words.value = "";
    for (const select of filters.querySelectorAll("select")) select.value = select.name === button.dataset.filter ? button.dataset.word : "";
    look();
    filters.scrollIntoView();
  });
}

function setPanels(width = memory.get("panels")) {
  if (width) { by("panels").value = width; by("board").style.setProperty("--panel", `${by("panels").value}px`); }
}
by("panels").addEventListener("input", (event) => { memory.set("panels", event.target.value); setPanels(event.target.value); });
setPanels();
look();

// --- the whole film -------------------------------------------------------------------------------

const film = by("film");
const pieces = [...document.querySelectorAll(".cutting button")];
if (!film) { // a draft has no film yet: its pieces lead to the shots
  for (const piece of pieces) piece.addEventListener("click", () => select(panelOf(shots.get(piece.dataset.shot))));
} else {
  const inside = () => {
    const frame = film.currentTime * fps + 0.01;
    const piece = pieces.findLast((p) => Number(p.dataset.start) <= frame) || pieces[0];
    for (const p of pieces) p.toggleAttribute("aria-current", p === piece), p === piece && p.setAttribute("aria-current", "true");
    const shot = shots.get(piece.dataset.shot);
    by("now").replaceChildren(`${shot.n}  ${shot.text}${shot.say ? `  “${shot.say}”` : ""}`);
  };
  film.addEventListener("timeupdate", inside);
  film.addEventListener("seeked", inside);
  for (const piece of pieces) piece.addEventListener("click", () => { film.currentTime = (Number(piece.dataset.start) + 0.5) / fps; });
}

// --- keys -------------------------------------------------------------------------------------------

const typing = (element) => element.matches("input:not([type=range]), select, textarea");
function largeKey(event) {
  const step = event.shiftKey ? Math.round(fps) : 1;
  const keys = {
    ArrowLeft: () => viewer.seek(viewer.frame - step), ArrowRight: () => viewer.seek(viewer.frame + step),
    ArrowUp: () => viewer.turn(-1), ArrowDown: () => viewer.turn(1), " ": () => viewer.toggle(),
    m: () => askMore(viewer.shot),
    c: () => (live.served ? live.choose(viewer.shot, viewer.take) : by("copy").click()),
  };
  if (event.key === " " && event.target.matches("button, a, summary") && event.target.id !== "play") return false;
  const digit = viewer.shot.takes[Number(event.key) - 1];
  const act = keys[event.key] || (event.key >= "1" && event.key <= "9" && digit && (() => viewer.show(viewer.shot, digit)));
  if (act) act();
  return Boolean(act);
}
function boardKey(event) {
  const keys = {
    ArrowLeft: () => move(-1), ArrowRight: () => move(1),
    " ": () => { if (!at) move(0); moving.isConnected && !moving.paused ? stop() : at && playIn(at); },
    m: () => at && shotOf(at).takes.length && askMore(shotOf(at)),
    Enter: () => at && viewer.open(shotOf(at), takeOf.get(at.dataset.shot)),
  };
  const elsewhere = !event.target.closest(".frame") && event.target.matches("button, a, video, summary, input");
  if (elsewhere && !/^[1-9]$/.test(event.key)) return false;
  const act = keys[event.key] || (/^[1-9]$/.test(event.key) && at && (() => showTake(at, Number(event.key))));
  if (act) act();
  return Boolean(act);
}
document.addEventListener("keydown", (event) => {
  if (event.metaKey || event.ctrlKey || event.altKey) return;
  if (typing(event.target)) { if (event.key === "Escape") event.target.blur(); return; }
  if (by("help").open) return;
  const everywhere = {
    "?": () => by("help").showModal(), d: turnTheme,
    "/": () => { if (viewer.isOpen) viewer.close(); filters.elements.words.focus(); },
  };
  const done = everywhere[event.key] ? (everywhere[event.key](), true) : viewer.isOpen ? largeKey(event) : boardKey(event);
  if (done) event.preventDefault();
});
by("theme").addEventListener("click", turnTheme);
by("keys").addEventListener("click", () => by("help").showModal());
