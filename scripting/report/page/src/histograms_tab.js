// One histogram for each measure, with its limits.
import { axis, Chart, on_scheme_change } from "./charts.js";
import { count_text, css_colour, h, number_text } from "./dom.js";
import { k_states, state_of } from "./colours.js";
import { check_of } from "./surface_tab.js";

const k_empty = 0.5; // height of an empty class on a logarithmic axis: below one
const k_limit_colours = { hard: "--fail", target: "--warn", usual: "--pass" };

/** Returns a sentence if the histogram cannot be drawn, else "". */
function trouble_of({ edges, counts }) {
  if (!Array.isArray(edges) || !Array.isArray(counts) || edges.length !== counts.length + 1 || counts.length === 0) return "This histogram is damaged: it needs one more edge than counts.";
  if (!edges.every((edge, k) => Number.isFinite(edge) && (k === 0 || edge > edges[k - 1]))) return "This histogram is damaged: its edges do not increase.";
  if (!counts.every((count) => Number.isFinite(count) && count >= 0)) return "This histogram is damaged: a count is not a number.";
  return "";
}

function config_of(histogram, is_log_count) {
  const { counts, limits = {}, unit } = histogram;
  const is_log = histogram.is_log && histogram.edges[1] > 0;
  const edges = is_log && histogram.edges[0] <= 0 ? [histogram.edges[1] / 2, ...histogram.edges.slice(1)] : histogram.edges;
  const shown = (count) => (is_log_count && count <= 0 ? k_empty : count);
  const data = counts.map((count, k) => ({ x: edges[k], y: shown(count) }));
  data.push({ x: edges[edges.length - 1], y: shown(counts[counts.length - 1]) });
  const middle = (k) => (is_log ? Math.sqrt(edges[k] * edges[k + 1]) : (edges[k] + edges[k + 1]) / 2);
  const colour = (k) => {
    const state = state_of(middle(Math.min(k, counts.length - 1)), limits, histogram.low_is_bad);
    return state === 0 ? css_colour("--series") : k_states[state].colour;
  };
  const lines = Object.keys(k_limit_colours).filter((name) => typeof limits[name] === "number").map((name) => ({ value: limits[name], name: `${name} ${number_text(limits[name], 3)}`, colour: css_colour(k_limit_colours[name]) }));
  // Limits close to the values are shown; distant limits would compress the values.
  const low = edges[0], high = edges[edges.length - 1];
  const span = is_log ? high / low : high - low;
  const near = lines.map((line) => line.value).filter((v) => (is_log ? v > 0 && v > low / Math.max(span, 10) && v < high * Math.max(span, 10) : v > low - span && v < high + span));
  return {
    type: "line",
    data: { datasets: [{ data, stepped: "before", fill: "origin", borderWidth: 1, pointRadius: 0, pointHitRadius: 0, borderColor: css_colour("--series"), segment: { backgroundColor: (c) => colour(c.p0DataIndex), borderColor: (c) => colour(c.p0DataIndex) } }] },
    options: {
      responsive: true,
      maintainAspectRatio: false,
      interaction: { mode: "nearest", axis: "x", intersect: false },
      scales: { x: axis(unit || "", is_log, { min: Math.min(low, ...near), max: Math.max(high, ...near) }), y: axis(histogram.counted ?? "count", is_log_count, is_log_count ? { min: k_empty } : { beginAtZero: true }) },
      plugins: {
        legend: { display: false },
        limit_lines: { list: lines },
        tooltip: {
          displayColors: false,
          callbacks: {
            title: ([item]) => {
              const k = Math.min(item.dataIndex, counts.length - 1);
              return `${number_text(histogram.edges[k])} to ${number_text(histogram.edges[k + 1])} ${unit ?? ""}`;
            },
            label: (item) => `${count_text(counts[Math.min(item.dataIndex, counts.length - 1)])} ${histogram.counted ?? ""}`,
          },
        },
      },
    },
  };
}

export function histograms_tab(app) {
  const { report } = app;
  const charts = [];
  let is_log_count = true;
  const figures = report.histograms.map((histogram) => {
    const total = (histogram.counts ?? []).reduce((sum, count) => sum + count, 0);
    const trouble = trouble_of(histogram);
    const canvas = h("canvas", { role: "img", "aria-label": `Histogram: ${histogram.title}` });
    const figure = h("figure.histogram", { id: `histogram_${histogram.measure}` }, h("figcaption", null, h("span.gate_name", null, histogram.gate), ` ${histogram.title}`, histogram.unit ? h("small", null, ` [${histogram.unit}]`) : null, h("small.total", null, `${count_text(total)} ${histogram.counted ?? ""}`)), trouble ? h("p.note.wrong", null, trouble) : h("div.chart", null, canvas));
    if (!trouble) charts.push({ histogram, canvas, chart: null });
    return figure;
  });
  const draw = () => {
    for (const entry of charts) {
      entry.chart?.destroy();
      entry.chart = new Chart(entry.canvas, config_of(entry.histogram, is_log_count));
    }
  };
  setTimeout(draw); // a canvas must be part of the page before it is drawn
  on_scheme_change(draw);
  app.show_histogram = (measure) => setTimeout(() => {
    const figure = document.getElementById(`histogram_${measure}`);
    figure?.scrollIntoView({ block: "start" });
    figure?.classList.add("flash");
    setTimeout(() => figure?.classList.remove("flash"), 1500);
  });
  const log = check_of("counts on a logarithmic axis", "log_counts", true, (is_on) => {
    is_log_count = is_on;
    draw();
  });
  return [h("h2", null, "Histograms"), h("div.form", null, log), figures];
}
