// Chart.js with the components that the page uses, and lines of limits.
import { Chart, Filler, Legend, LinearScale, LineController, LineElement, LogarithmicScale, PointElement, ScatterController, Tooltip } from "chart.js";
import { css_colour, number_text } from "./dom.js";

/** Draws vertical lines with names: options.plugins.limit_lines = [{value, name, colour}]. */
const limit_lines = {
  id: "limit_lines",
  afterDatasetsDraw(chart, _, options) {
    const { ctx, chartArea: area } = chart;
    (options.list ?? []).forEach(({ value, name, colour }, k) => {
      const x = chart.scales.x.getPixelForValue(value);
      if (!(x >= area.left - 0.5 && x <= area.right + 0.5)) return;
      ctx.save();
      ctx.strokeStyle = colour;
      ctx.fillStyle = colour;
      ctx.lineWidth = 1.5;
      ctx.setLineDash(name.startsWith("hard") ? [] : name.startsWith("target") ? [6, 3] : [2, 3]);
      ctx.beginPath();
      ctx.moveTo(x, area.top);
      ctx.lineTo(x, area.bottom);
      ctx.stroke();
      ctx.font = "600 10.5px system-ui, sans-serif";
      const is_left = x > area.left + 0.7 * (area.right - area.left);
      ctx.textAlign = is_left ? "right" : "left";
      const width = ctx.measureText(name).width, at = x + (is_left ? -5 : 5), line = area.top + 10 + 14 * k;
      ctx.save();
      ctx.globalAlpha = 0.8; // drawn over the bars
      ctx.fillStyle = css_colour("--panel");
      ctx.fillRect(is_left ? at - width - 2 : at - 2, line - 10, width + 4, 13);
      ctx.restore();
      ctx.fillText(name, at, line);
      ctx.restore();
    });
  },
};

Chart.register(Filler, Legend, LinearScale, LineController, LineElement, LogarithmicScale, PointElement, ScatterController, Tooltip, limit_lines);
Chart.defaults.animation = false;
Chart.defaults.font.family = "system-ui, sans-serif";
Chart.defaults.font.size = 11;

/** Returns axis options with the colours of the page. A logarithmic axis has numbers at decades only. */
export function axis(title, is_log, more = {}) {
  const text = css_colour("--text_soft"), grid = css_colour("--grid");
  return {
    type: is_log ? "logarithmic" : "linear",
    title: { display: Boolean(title), text: title, color: text },
    grid: { color: grid },
    border: { color: grid },
    ticks: { includeBounds: false, color: text, maxRotation: 0, autoSkipPadding: 10, callback: (value) => (is_log && Math.abs(Math.log10(value) - Math.round(Math.log10(value))) > 1e-6 ? "" : number_text(value, 3)) },
    ...more,
  };
}

/** Calls a function again if the browser changes between light and dark mode. */
export function on_scheme_change(call) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", call);
}

export { Chart };
