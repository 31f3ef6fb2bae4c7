// Light or dark as the reader last chose; without a choice as the system is.
"use strict";
const memory = {
  get(key) { try { return localStorage.getItem("vds." + key); } catch { return null; } },
  set(key, value) { try { localStorage.setItem("vds." + key, value); } catch { /* no storage: not kept */ } },
};
if (memory.get("theme")) document.documentElement.dataset.theme = memory.get("theme");
function turnTheme() {
  const dark = document.documentElement.dataset.theme
    ? document.documentElement.dataset.theme === "dark"
    : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "light" : "dark";
  memory.set("theme", document.documentElement.dataset.theme);
}
