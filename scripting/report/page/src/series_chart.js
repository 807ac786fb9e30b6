// A chart of any quantity over any parameter; a second parameter separates the lines.
import { axis, Chart, on_scheme_change } from "./charts.js";
import { css_colour, fill, h, number_text } from "./dom.js";
import { select_of } from "./surface_tab.js";

const k_line_colours = ["#3b78b5", "#d1762c", "#3f9a61", "#b8496b", "#7a63b5", "#8a7a2c", "#2f9aa0", "#a0583f"];

/**
 * Returns the lines of the chart: [{name, points: [{x, y, name, is_bad}]}], without cases that lack the quantity or the parameter.
 * A parameter that is a number in all cases is the axis. For other parameters the axis has their distinct values in order, which are in `labels`.
 */
export function lines_of(app) {
  const { figure, over, by } = app.state.values;
  const column = app.columns.find((entry) => entry.key === figure);
  const parameter = (name, entry) => app.columns.find((c) => c.key === `p:${name}`)?.of(entry);
  const values = [...new Set(app.series.cases.map((entry) => parameter(over, entry)).filter((value) => value !== undefined && value !== null))];
  const labels = values.every((value) => typeof value === "number") ? null : values.map(String).sort((a, b) => a.localeCompare(b, "en", { numeric: true }));
  const lines = new Map();
  let n_left_out = 0;
  for (const entry of app.series.cases) {
    const value = parameter(over, entry), y = column?.of(entry);
    const x = labels ? labels.indexOf(String(value)) : value;
    const is_gap = typeof y !== "number";  // a failed case interrupts the line
    if (is_gap) ++n_left_out;
    if (typeof x !== "number" || (labels && x < 0)) {
      if (!is_gap) ++n_left_out;
      continue;
    }
    const name = by && by !== over ? `${by} ${value_text(parameter(by, entry))}` : (column?.title ?? "");
    if (!lines.has(name)) lines.set(name, []);
    lines.get(name).push({ x, y: is_gap ? null : y, name: entry.name, is_bad: entry.verdict === "INVALID" });
  }
  return { column, n_left_out, labels, lines: [...lines].map(([name, points]) => ({ name, points: points.sort((a, b) => a.x - b.x) })) };
}

function value_text(value) {
  return typeof value === "number" ? number_text(value) : (value ?? "\u2013");
}

function x_axis(title, labels) {
  const made = axis(title, false);
  if (labels) Object.assign(made, { min: -0.5, max: labels.length - 0.5 }, { afterBuildTicks: (scale) => (scale.ticks = labels.map((_, k) => ({ value: k }))), ticks: { ...made.ticks, callback: (x) => labels[x] ?? "" } });
  return made;
}

export function chart_section(app) {
  const { state, series } = app;
  const figures = app.columns.filter((column) => column.kind === "figure").map((column) => [column.key, column.unit ? `${column.title} [${column.unit}]` : column.title]);
  const parameters = series.parameters.map((name) => [name, name]);
  const canvas = h("canvas", { role: "img", "aria-label": "Chart of a quantity over a parameter" });
  const note = h("p.note");
  let chart = null;
  const draw = () => {
    const { column, lines, labels, n_left_out } = lines_of(app);
    app.n_points = lines.reduce((sum, line) => sum + line.points.filter((point) => point.y !== null).length, 0);
    app.n_lines = lines.length;
    fill(note, n_left_out ? `${n_left_out} of ${series.cases.length} cases have no value here.` : "", lines.some((line) => line.points.some((point) => point.is_bad)) ? " A red cross marks an INVALID mesh." : "", app.n_points ? "" : " Nothing to draw.");
    chart?.destroy();
    const is_log = column?.is_log && lines.every((line) => line.points.every((p) => p.y === null || p.y > 0));
    chart = new Chart(canvas, {
      type: "line",
      data: {
        datasets: lines.map((line, k) => {
          const colour = k_line_colours[k % k_line_colours.length];
          return { label: line.name, data: line.points, borderColor: colour, borderWidth: 1.8, backgroundColor: colour, pointRadius: line.points.map((p) => (p.is_bad ? 6 : 3.5)), pointStyle: line.points.map((p) => (p.is_bad ? "crossRot" : "circle")), pointBorderColor: line.points.map((p) => (p.is_bad ? css_colour("--fail") : colour)), pointBorderWidth: line.points.map((p) => (p.is_bad ? 2.5 : 1)) };
        }),
      },
      options: {
        responsive: true,
        maintainAspectRatio: false,
        interaction: { mode: "nearest", intersect: false },
        scales: { x: x_axis(state.get("over"), labels), y: axis(column ? `${column.title}${column.unit ? ` [${column.unit}]` : ""}` : "", is_log) },
        plugins: { legend: { display: lines.length > 1, labels: { color: css_colour("--text"), boxWidth: 12 } }, limit_lines: { list: [] }, tooltip: { callbacks: { title: ([item]) => item.raw.name, label: (item) => `${item.dataset.label}: ${number_text(item.raw.y)}` } } },
      },
    });
  };
  const form = h(
    "div.form.inline",
    null,
    select_of("Figure", "figure", figures, state.get("figure"), (figure) => state.set({ figure })),
    select_of("over", "over", parameters, state.get("over"), (over) => state.set({ over })),
    select_of("lines by", "by", [["", "\u2013"], ...parameters], state.get("by"), (by) => state.set({ by })),
  );
  state.on(["figure", "over", "by"], draw);
  on_scheme_change(draw);
  setTimeout(draw);
  return h("section.chart_section", null, h("div.section_head", null, h("h2", null, "Figure over parameter")), form, h("div.chart.tall", null, canvas), note);
}
