"""How the page looks: its styles, and the script that fits figures to their places."""

from __future__ import annotations

__all__ = ["LOOK", "RESIZE"]

BASE = """
@layer base {
  *, ::after, ::before, ::backdrop, ::file-selector-button {
    box-sizing: border-box; margin: 0; padding: 0; border: 0 solid;
  }
  html { line-height: 1.5; -webkit-text-size-adjust: 100%; tab-size: 4; }
  h1, h2, h3, h4, h5, h6 { font-size: inherit; font-weight: inherit; }
  a { color: inherit; text-decoration: inherit; }
  b, strong { font-weight: bolder; }
  code, kbd, samp, pre { font-family: ui-monospace, Menlo, Consolas, monospace; font-size: 1em; }
  sub, sup { font-size: 75%; line-height: 0; position: relative; vertical-align: baseline; }
  sub { bottom: -0.25em; }
  sup { top: -0.5em; }
  table { text-indent: 0; border-color: inherit; border-collapse: collapse; }
  ol, ul, menu { list-style: none; }
  img, svg, video, canvas { display: block; vertical-align: middle; }
  button, input, select, textarea, ::file-selector-button {
    font: inherit; letter-spacing: inherit; color: inherit; border-radius: 0; opacity: 1;
    background-color: transparent;
  }
  ::placeholder { opacity: 1; color: color-mix(in oklab, currentcolor 50%, transparent); }
  textarea { resize: vertical; }
  button, input:where([type="button"]), ::file-selector-button { appearance: button; }
}
@layer utilities {
  .items-center { align-items: center; }
  .items-end { align-items: flex-end; }
  .items-start { align-items: flex-start; }
  .justify-between { justify-content: space-between; }
  .justify-center { justify-content: center; }
  .self-stretch { align-self: stretch; }
  .grow { flex-grow: 1; }
  .gap-0 { gap: 0; }
  .gap-1 { gap: 0.25rem; }
  .gap-2 { gap: 0.5rem; }
  .gap-3 { gap: 0.75rem; }
  .gap-4 { gap: 1rem; }
  .w-24 { width: 6rem; }
  .w-36 { width: 9rem; }
  .w-52 { width: 13rem; }
  .w-56 { width: 14rem; }
  .w-full { width: 100%; }
  .whole { width: 100%; max-width: 1500px; margin-inline: auto; }
  .pl-4 { padding-left: 1rem; }
  .hidden { display: none; }
  .break-any { overflow-wrap: anywhere; }
  .wide { flex: 1 1 14rem; }
  .font-bold { font-weight: 700; }
  .bg-transparent { background-color: transparent; }
}
"""
"""What the page takes of Tailwind, whose own script looks through the page at every change."""
LOOK = (
    BASE
    + """
:root { --hint: #5f6672; --problem: #b3261e; }
.body--dark { --hint: #a9b0bb; --problem: #ff8a80; }
body { font-family: system-ui, -apple-system, "Segoe UI", sans-serif; }
.hint { color: var(--hint); font-size: 0.83rem; line-height: 1.3; }
.stale { font-size: 0.85rem; border-left: 3px solid #E69F00; padding-left: 0.6rem; }
.problem { color: var(--problem); font-size: 0.85rem; font-weight: 600; }
.switches { gap: 0 1rem; }
.subhead.group { border-top: 1px solid rgba(127, 127, 127, 0.3); padding-top: 0.6rem; }
.subhead.group { width: 100%; }
.subhead { font-weight: 600; margin-top: 0.4rem; }
.facts { gap: 0.4rem 1.25rem; }
.headline { font-size: 1.25rem; font-weight: 600; line-height: 1.35; text-wrap: balance; }
.headline.second { font-size: 0.95rem; }
.whole-contact { font-size: 1.05rem; font-weight: 600; line-height: 1.4; max-width: 60rem; }
.waiting { width: 100%; display: grid; gap: 0.75rem; }
.bone { border-radius: 4px; background: rgba(127, 127, 127, 0.14); height: 1.4rem; width: 70%; }
.bone { animation: breathe 1.6s ease-in-out infinite alternate; }
.bone.short { width: 45%; }
.bone.block { height: 220px; width: 100%; }
.bone.row { width: 90%; height: 2.4rem; }
@keyframes breathe { to { opacity: 0.45; } }
@media (prefers-reduced-motion: reduce) { .bone { animation: none; } }
.words { display: grid; grid-template-columns: max-content 1fr; gap: 0.25rem 1rem; }
.fact .value { font-size: 0.95rem; font-weight: 600; line-height: 1.35; }
.fact .hint { font-size: 0.76rem; }
.fact.said { position: absolute; width: 1px; height: 1px; overflow: hidden; }
.fact.said { clip-path: inset(50%); }
.answer { position: relative; width: 100%; }
.verdict { display: flex; flex-wrap: wrap; align-items: flex-start; gap: 0.2rem 1rem; }
.verdict { padding-top: 0.7rem; }
.verdict .sentence { flex: 1 1 20rem; font-weight: 600; line-height: 1.35; }
.standing { display: flex; flex-direction: column; align-items: flex-end; margin-left: auto; }
.standing .hint { font-size: 0.76rem; max-width: 15rem; text-align: right; }
.verdict .remark { flex: 1 0 100%; }
.badge { border-radius: 999px; padding: 0 0.6rem 0 0.4rem; font-size: 0.83rem; font-weight: 600; }
.badge .q-icon { font-size: 1.1rem; margin-right: 0.3rem; }
.badge.q-btn { border: 1.5px solid currentColor; min-height: 1.8rem; }
.badge.q-btn.holds { color: #00644a; }
.badge.q-btn.near { color: #00518a; }
.badge.q-btn.doubtful { color: #8a4b00; }
.body--dark .badge.q-btn.holds { color: #5fd6ae; }
.body--dark .badge.q-btn.near { color: #8cc8f0; }
.body--dark .badge.q-btn.doubtful { color: #ffb95c; }
.limits { padding: 0.9rem 1rem; max-width: 34rem; font-size: 0.88rem; line-height: 1.4; }
.limit { border-left: 3px solid #E69F00; padding-left: 0.6rem; }
.new-study { width: 100%; max-width: 1180px; padding: 1.2rem 1.4rem; gap: 0.9rem; }
.steps { display: grid; gap: 1.2rem 2rem; width: 100%; }
@media (min-width: 900px) { .steps { grid-template-columns: repeat(3, minmax(0, 1fr)); } }
.step .number { width: 1.7rem; height: 1.7rem; border-radius: 50%; text-align: center; }
.step .number { background: #0072B2; color: #ffffff; font-weight: 700; line-height: 1.7rem; }
.step .subhead { margin: 0; font-size: 1.05rem; }
.so-far { flex: 1 1 20rem; font-weight: 600; line-height: 1.4; min-height: 2.8em; }
.new-end { position: sticky; bottom: -1.2rem; padding: 0.7rem 0; z-index: 1; background: #fff; }
.body--dark .new-end { background: #1d1d1d; }
.tab-group { font-size: 0.7rem; font-weight: 600; color: var(--hint); white-space: nowrap; }
.tab-group { padding: 0 0.35rem 0 0.7rem; text-transform: uppercase; letter-spacing: 0.04em; }
.grouped .q-tab { min-height: 34px; }
.tab-line { display: none; }
@media (min-width: 700px) {
  .verdict.beside { position: absolute; right: 0; z-index: 2; }
  .verdict.beside + .q-tab-panels .headline:not(.second),
  .verdict.beside + .q-tab-panels .whole-contact { padding-right: 13.5rem; }
  .headline-place { min-height: 3.4rem; }
  .tab-line { display: block; flex-basis: 100%; height: 0; }
  .tab-group:first-child, .tab-line + .tab-group { padding-left: 0; min-width: 5.4rem; }
}
.figures { display: grid; gap: 1rem; grid-template-columns: minmax(0, 1fr); }
.figures { align-items: start; }
.pair { display: grid; gap: 1rem; grid-template-columns: minmax(0, 1fr); align-items: start; }
.pair > * { min-width: 0; }
@media (min-width: 1100px) {
  .figures, .alone .pair { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  /* without entries beside it, an answer takes the whole width */
  .figures.alone { grid-template-columns: minmax(0, 1fr); }
  .figures.alone > .entries { order: -1; }
  .figures.alone > .entries > .narrow { max-width: none; }
}
.figures > * { min-width: 0; }
.js-plotly-plot { position: relative; }
.here { position: absolute; border-left: 2px solid var(--hint); pointer-events: none; }
.here[hidden] { display: none; }
.sliders { gap: 0.4rem 1.6rem; align-items: flex-end; }
.slider .hint { font-size: 0.76rem; }
.slider { flex: 1 1 130px; min-width: 130px; padding: 0 8px; }
.knobs { flex: 6 1 0; gap: 0.4rem 1.6rem; align-items: flex-end; }
@media (max-width: 699px) {
  .sliders { display: contents; }
  .load { position: sticky; top: 72px; z-index: 3; width: 100%; flex: none; background: #fff; }
  .body--dark .load { background: #121212; }
  .knobs { flex: none; width: 100%; gap: 0.4rem 1rem; }
  .answer .sliders { display: flex; }
  .examples .q-field__native, .examples .q-field__label { opacity: 0; }
}
.skip { position: absolute; left: -9999px; }
.skip:focus { left: 8px; top: 8px; z-index: 9999; padding: 8px 12px; }
.skip:focus { background: #fff; color: #00518a; }
h1.name { font-size: 1.125rem; font-weight: 700; line-height: 1.75rem; letter-spacing: 0; }
@media (min-width: 700px) { .when-narrow { display: none; } }
.scroll-x { overflow-x: auto; }
.section { display: block; width: 100%; min-width: 640px; height: auto; }
.q-uploader { width: 260px; }
/* under the pointer a button gets darker, so that its words stay readable */
.q-btn.bg-primary > .q-focus-helper { color: #000; }
.q-btn.bg-primary > .q-focus-helper::after { display: none; }
.q-uploader__list { display: none; }
#q-loading-bar { display: none; }
.scroll-x .q-table { min-width: 620px; }
/* tables as cards: a heading, then name and value in one line */
.q-table__grid-item { padding: 4px 0; }
.q-table__grid-item-card { padding: 8px 12px; border: 1px solid rgba(127, 127, 127, 0.3); }
.q-table__grid-item-row { display: flex; justify-content: space-between; padding: 2px 0; }
.q-table__grid-item-title { flex: none; margin-right: 1rem; }
.q-table__grid-item-row:has(.q-table__grid-item-value:empty) { display: none; }
.q-table__grid-item-row:first-child .q-table__grid-item-title { display: none; }
.q-table__grid-item-row:first-child .q-table__grid-item-value { font-weight: 600; }
.q-table__grid-item-row + .q-table__grid-item-row .q-table__grid-item-value { text-align: right; }
.narrow { max-width: 34rem; }
.code textarea { font-family: ui-monospace, monospace; font-size: 0.8rem; line-height: 1.35; }
@supports (field-sizing: content) {
  .code textarea { field-sizing: content; height: auto !important; }
}
.listing {
  font-family: ui-monospace, monospace; font-size: 0.8rem; white-space: pre; overflow-x: auto;
}
.js-plotly-plot .main-svg text { fill: currentColor !important; }
.js-plotly-plot .main-svg { background: transparent !important; }
.js-plotly-plot .node-label { text-shadow: none !important; }
.js-plotly-plot .hoverlayer text { fill: #222 !important; }
.body--dark .scatterlayer .lines, .body--dark .legendlines { filter: brightness(1.4); }
.body--dark [data-figure="map"] .legendlines path { stroke: #dddddd !important; }
.body--dark [data-figure="bands"] :is(.fills, .legendfill) { filter: brightness(1.9); }
.body--dark .layer-below .shapelayer { opacity: 0.5; }
.q-tab { padding: 0 5px; }
.whole .q-field { max-width: 100%; }
.q-field__messages { line-height: 1.2; }
.q-field--with-bottom { padding-bottom: 0; }
.q-field--with-bottom .q-field__bottom { position: static; transform: none; padding: 3px 0 6px; }
.q-header .q-field__label { color: #ffffff; }
@media (prefers-reduced-motion: reduce) { * { transition: none !important; } }
/* what is important in the framework yields only to an earlier layer */
@layer overrides {
  @media (max-width: 699px) {
    .fresh .block { display: none !important; }
    .fresh .q-icon { margin: 0 !important; }
  }
  @media (min-width: 700px) { .grouped .q-tabs__content { flex-wrap: wrap !important; } }
  :root { --focus: #0072B2; }
  .body--dark { --focus: #56B4E9; }
  .q-header { --focus: #ffffff; }
  :focus-visible { outline: 2px solid var(--focus) !important; outline-offset: 2px; }
  .body--dark .text-primary,
  .body--dark .q-field--highlighted .q-field__label { color: #56B4E9 !important; }
}
"""
)


RESIZE = """
<script type="module">
const here = (plot) => {
  const around = plot.closest("[data-at]"), { xaxis } = plot._fullLayout ?? {};
  if (!around || !xaxis) return;
  let line = plot.querySelector(":scope > .here");
  if (!line) {
    line = Object.assign(document.createElement("div"), { className: "here" });
    plot.append(line);
  }
  const { _offset: left, _length: width } = xaxis, { t, h } = plot._fullLayout._size;
  const x = xaxis.d2p(Number(around.dataset.at));
  line.hidden = !(x >= 0 && x <= width);
  Object.assign(line.style, { left: `${left + x}px`, top: `${t}px`, height: `${h}px` });
};
const sized = new ResizeObserver(async (entries) => {
  const { Plotly } = await import("nicegui-plotly");
  for (const { target } of entries)
    if (target.offsetParent && target._fullLayout) Plotly.Plots.resize(target).catch(() => {});
});
window.redraw = async (calls) => {
  const { Plotly } = await import("nicegui-plotly");
  return Promise.all(calls.map(async ([id, name, ...args]) => {
    const plot = document.getElementById(id);
    // one without curves may still be drawn by the framework, as it was when it came
    if (!plot?.data?.length) return false;
    await Plotly[name](plot, ...args);
    return true;
  }));
};
const VALUE = ["aria-label", "aria-valuemin", "aria-valuemax", "aria-valuenow", "aria-valuetext"];
const spoken = (slider) => {
  const handle = slider.querySelector(".q-slider__track-container");
  if (!handle) return;
  slider.setAttribute("role", "group");
  handle.setAttribute("role", "slider");
  for (const name of VALUE)
    if (slider.hasAttribute(name)) handle.setAttribute(name, slider.getAttribute(name));
};
const said = new MutationObserver((changes) => changes.forEach(({ target }) => spoken(target)));
const met = (svg) => {
  const around = svg.parentElement.closest(".scroll-x"), grain = svg.querySelector(".loaded");
  if (!around || !grain || around.scrollWidth <= around.clientWidth) return;
  const [box, there] = [around, grain].map((e) => e.getBoundingClientRect());
  if (there.left < box.left || there.right > box.right)
    around.scrollLeft += (there.left + there.right - box.left - box.right) / 2;
};
new MutationObserver(() => {
  if (innerWidth < 700)
    for (const svg of document.querySelectorAll("svg.section:not([data-met])")) {
      svg.dataset.met = "";
      met(svg);
    }
  for (const slider of document.querySelectorAll(".q-slider:not([data-spoken])")) {
    slider.dataset.spoken = "";
    spoken(slider);
    said.observe(slider, { attributeFilter: VALUE });
  }
  for (const plot of document.querySelectorAll(".js-plotly-plot:not([data-sized])")) {
    plot.dataset.sized = "";
    sized.observe(plot);
  }
  for (const plot of document.querySelectorAll("[data-at] .js-plotly-plot")) {
    plot.followed ??= () => here(plot);
    // a plot that is made anew forgets who listens
    if (plot.on && !plot._ev.listeners("plotly_afterplot").includes(plot.followed)) {
      plot.on("plotly_afterplot", plot.followed);
      here(plot);
    }
  }
}).observe(document.body, { childList: true, subtree: true });
new MutationObserver(() => document.querySelectorAll("[data-at] .js-plotly-plot").forEach(here))
  .observe(document.body, { subtree: true, attributeFilter: ["data-at"] });
</script>
"""
"""Figures follow the width of their place; one that is out of sight has none. The operating load,
which moves most, is a line over them: `data-at` around them says where. A cross-section that is
wider than the window shows a particle that is loaded. A slider of the framework has its role and
value beside what takes the focus: readers of the screen say what has it."""
