// The library: found by words, drawn when opened.
const rows = [...document.querySelectorAll(".row")];
const texts = new Map(rows.map((row) => [row, row.textContent.replaceAll("_", " ").toLowerCase()]));
function find() {
  const words = document.getElementById("words").value.replaceAll("_", " ").toLowerCase().split(/\s+/).filter(Boolean);
  for (const row of rows) row.hidden = !words.every((word) => texts.get(row).includes(word));
  for (const section of document.querySelectorAll("section")) section.hidden = !section.querySelector(".row:not([hidden])");
  const count = rows.filter((row) => !row.hidden).length;
  document.getElementById("found").textContent = words.length ? `${count} found` : "";
}
document.getElementById("words").addEventListener("input", find);
document.getElementById("search").addEventListener("submit", (event) => event.preventDefault());
async function draw(row) {
  const box = row.querySelector(".drawn");
  if (!row.open || box.childElementCount || box.textContent) return;
  box.textContent = "Drawing…";
  const answer = await fetch(row.dataset.picture).catch(() => null);
  if (!answer || !answer.ok) {
    box.textContent = (await answer?.json().catch(() => null))?.error || "It could not be drawn.";
    return;
  }
  const picture = document.createElement("img");
  picture.alt = row.querySelector(".name").textContent;
  picture.src = row.dataset.picture;
  box.replaceChildren(picture);
}
find(); // what was typed or opened while the page was still coming is not told again
for (const row of rows) {
  row.addEventListener("toggle", () => draw(row));
  draw(row);
}
