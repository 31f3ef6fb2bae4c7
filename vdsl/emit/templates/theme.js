// Light or dark as the reader last chose; without a choice as the system is.
"use strict";
// A page opened from disk sometimes loses what it wrote to localStorage at a reload (Chromium, about
// two in a hundred); the tab's own sessionStorage keeps it, localStorage carries it to later visits.
const memory = {
  get(key) {
    for (const store of ["sessionStorage", "localStorage"]) {
      try {
        const value = window[store].getItem("vds." + key);
        if (value !== null) return value;
      } catch { /* no storage: nothing kept */ }
    }
    return null;
  },
  set(key, value) {
    for (const store of ["sessionStorage", "localStorage"]) {
      try { window[store].setItem("vds." + key, value); } catch { /* no storage: not kept */ }
    }
  },
};
if (memory.get("theme")) document.documentElement.dataset.theme = memory.get("theme");
function turnTheme() {
  const dark = document.documentElement.dataset.theme
    ? document.documentElement.dataset.theme === "dark"
    : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "light" : "dark";
  memory.set("theme", document.documentElement.dataset.theme);
}
