// The worst locations of every gate.
import { chip, state_class } from "./banner.js";
import { button, h, number_text, position_text, quantity_text } from "./dom.js";
import { check_of, select_of } from "./surface_tab.js";

/** Returns "3.1 deg, limit 5 deg" for a location, or the violation if there is no value. */
export function value_text(place) {
  if (typeof place.value !== "number") return place.title;
  const limit = typeof place.limit === "number" ? `, limit ${quantity_text(place.limit, place.unit)}` : "";
  return `${quantity_text(place.value, place.unit)}${limit}`;
}

export function place_title(place) {
  return `${place.gate} ${place.title}`;
}

export function place_text(place) {
  return typeof place.value === "number" ? `${value_text(place)} \u00b7 ${place.what}` : place.what;
}

/** Returns groups of locations in the order of the report: by gate and measure, with locations that the input surface forces in separate groups. */
function groups_of(places) {
  const groups = new Map();
  places.forEach((place, k) => {
    const key = `${place.gate}\n${place.measure ?? ""}\n${place.state === "forced"}`;
    if (!groups.has(key)) groups.set(key, { gate: place.gate, title: place.title, state: place.state, list: [] });
    groups.get(key).list.push(k);
  });
  return [...groups.values()];
}

export function places_tab(app) {
  const { report, state } = app;
  const rows = new Map();
  const groups = groups_of(report.places).map((group) => {
    const list = group.list.map((k) => {
      const place = report.places[k];
      const row = h(
        `button.row.place.${state_class(place.state)}`,
        { type: "button", id: `place_${k}`, onclick: () => (state.get("place") === k ? app.view && app.fly_to_place(k) : state.set({ place: k })) },
        h("span.place_value", null, typeof place.value === "number" ? quantity_text(place.value, place.unit) : (place.measure ?? place.state).replaceAll("_", " ")),
        h("span.place_what", null, place.what, h("small", null, ` at ${position_text(place.at)}`)),
      );
      rows.set(k, row);
      return row;
    });
    const limit = report.places[group.list[0]].limit;
    const unit = report.places[group.list[0]].unit;
    return { gate: group.gate, element: h("section.group_of_places", null, h("h3", null, h("span.gate_name", null, group.gate), ` ${group.title} `, chip(group.state), typeof limit === "number" ? h("small", null, ` limit ${quantity_text(limit, unit)}`) : null), h("div.rows", null, list)) };
  });
  const gates = [...new Set(report.places.map((place) => place.gate))];
  const filter = select_of("Gate", "gate_filter", [["", `all ${gates.length}`], ...gates.map((gate) => [gate, gate])], state.get("gate"), (gate) => state.set({ gate }));
  const markers = check_of("show these locations as markers", "places_markers", state.get("markers"), (is_on) => state.set({ markers: is_on }));
  const step = (by) => {
    const list = app.listed_places();
    if (!list.length) return;
    const at = list.indexOf(state.get("place"));
    state.set({ place: list[(at + by + list.length + (at < 0 && by < 0 ? 1 : 0)) % list.length] });
  };
  const refresh = ({ gate, place, markers: shown }) => {
    for (const group of groups) group.element.hidden = Boolean(gate) && group.gate !== gate;
    rows.forEach((row, k) => row.setAttribute("aria-pressed", String(k === place)));
    filter.lastChild.value = gate;
    markers.firstChild.checked = shown;
    if (place >= 0 && !rows.get(place)?.closest("[hidden]")) rows.get(place)?.scrollIntoView({ block: "nearest" });
  };
  state.on(["gate", "place", "markers"], refresh);
  setTimeout(() => refresh(state.values));
  return [
    h("h2", null, "Worst locations"),
    h("div.form.sticky", null, filter, markers, h("div.buttons", null, button("\u2039 previous", () => step(-1), { id: "place_previous", kind: ".small" }), button("next \u203a", () => step(1), { id: "place_next", kind: ".small" }), button("No location", () => state.set({ place: -1 }), { id: "place_none", kind: ".small" }))),
    groups.map((group) => group.element),
    h("p.note", null, `${number_text(report.places.length)} locations. The camera looks from outside the body; the marker is visible through the surface.`),
  ];
}
