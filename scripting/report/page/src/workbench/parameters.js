// The arguments of the script: sliders for arguments with limits, fields for the others.
import { button, fill, h } from "../dom.js";
import { ReportError, sentence_of } from "../errors.js";
import { post } from "./server.js";

/** Returns the value in the form of the command line. */
function text_of(parameter, value) {
  return typeof value === "number" ? String(Number(value.toPrecision(10))) : String(value);
}

/** Returns the step of a slider: that of the script, else a round value of about a hundredth of the range. */
function step_of({ step, min, max }) {
  if (typeof step === "number") return step;
  const rough = (max - min) / 200;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough);
}

/** Sends values one after the other. While one value is on its way, only the latest value waits. */
class Sender {
  constructor(bench) {
    this.bench = bench;
    this.waiting = null;
    this.is_busy = false;
  }

  send(values, is_dragging) {
    this.waiting = { values: { ...this.waiting?.values, ...values }, is_dragging };
    this.go();
  }

  async go() {
    if (this.is_busy) return;
    this.is_busy = true;
    try {
      while (this.waiting) {
        const body = this.waiting;
        this.waiting = null;
        await post("values", body);
      }
    } catch (error) {
      if (!(error instanceof ReportError)) throw error;
      this.bench.say_for_a_while(sentence_of(error));
    } finally {
      this.is_busy = false;
    }
  }
}

function number_row(parameter, send) {
  const { name, min, max, unit } = parameter;
  const field = h("input.value", { type: "number", step: "any", id: `value_${name}`, "aria-label": name });
  const has_limits = typeof min === "number" && typeof max === "number";
  const slider = has_limits ? h("input.slider", { type: "range", min, max, step: step_of(parameter), id: `slider_${name}`, "aria-label": name, title: `${min} to ${max} ${unit}` }) : null;
  slider?.addEventListener("input", () => {
    field.value = slider.value;
    send(text_of(parameter, Number(slider.value)), true);
  });
  slider?.addEventListener("change", () => send(text_of(parameter, Number(slider.value)), false));
  field.addEventListener("change", () => {
    if (!Number.isFinite(field.valueAsNumber)) return;
    if (slider) slider.value = field.value;
    send(text_of(parameter, field.valueAsNumber), false);
  });
  const show = (value) => {
    if (document.activeElement !== field) field.value = Number(value.toPrecision(8));
    if (slider && document.activeElement !== slider) slider.value = value;
  };
  return { element: [field, h("span.unit", null, unit), slider], show };
}

function row_of(parameter, send) {
  const { name, initial, value } = parameter;
  if (typeof (initial ?? value) === "number") return number_row(parameter, send);
  if (typeof initial === "boolean") {
    const box = h("input", { type: "checkbox", id: `value_${name}`, onchange: () => send(String(box.checked), false) });
    return { element: [box], show: (v) => (box.checked = v) };
  }
  const field = h("input.text", { type: "text", id: `value_${name}`, "aria-label": name, onchange: () => send(field.value, false) });
  return { element: [field], show: (v) => document.activeElement !== field && (field.value = v ?? "") };
}

export function parameters_panel(bench) {
  const sender = new Sender(bench);
  const list = h("div.parameters", { id: "parameters" });
  const save = button("Write to script", () => post("save", {}).catch((error) => bench.say_for_a_while(sentence_of(error))), { title: "Write these values as defaults into args{} of the script", kind: ".small", id: "save_values" });
  const reset = button("Reset", () => sender.send(Object.fromEntries((bench.state.get("news")?.parameters ?? []).map(({ name }) => [name, null])), false), { title: "Reset all values to those of the script", kind: ".small", id: "reset_values" });
  const command = h("code.command", { title: "The same run on the command line" });
  const panel = h("section.parameters_panel", { hidden: true }, h("h2", null, "Arguments ", h("span.h2_buttons", null, reset, save)), list, command);
  let rows = new Map(), signature = "";
  const refresh = ({ news }) => {
    if (!news) return;
    panel.hidden = news.parameters.length === 0;
    const now = JSON.stringify(news.parameters.map(({ value, ...rest }) => rest));
    if (now !== signature) {
      signature = now;
      rows = new Map(news.parameters.map((parameter) => [parameter.name, row_of(parameter, (text, is_dragging) => sender.send({ [parameter.name]: text }, is_dragging))]));
      fill(list, news.parameters.map((parameter) => h("div.parameter", { "data-name": parameter.name }, h("label", { for: `value_${parameter.name}` }, parameter.name), rows.get(parameter.name).element)));
    }
    for (const parameter of news.parameters) {
      rows.get(parameter.name).show(parameter.value);
      list.querySelector(`[data-name="${CSS.escape(parameter.name)}"]`)?.classList.toggle("changed", parameter.name in news.values);
    }
    const given = Object.entries(news.values);
    save.disabled = reset.disabled = given.length === 0;
    command.hidden = given.length === 0;
    command.textContent = `sterna run ${news.file} ${given.map(([name, text]) => `${name}=${/[^\w.+-]/.test(text) ? `'${text}'` : text}`).join(" ")}`;
  };
  bench.state.on(["news"], refresh);
  return panel;
}
