// Tabs by the WAI-ARIA pattern: arrow keys change the tab, and the panel of a tab is made when it is shown for the first time.
import { append, h } from "./dom.js";

export class Tabs {
  /** list of {name, title, make(): element or list}; chosen(name) is called if the user selects a tab. */
  constructor(list, chosen) {
    this.list = list;
    this.chosen = chosen;
    this.bar = h("div.tabs", { role: "tablist" });
    this.body = h("div.tab_bodies");
    this.parts = new Map();
    for (const { name, title, count } of list) {
      const tab = h("button.tab", { type: "button", role: "tab", id: `tab_${name}`, "aria-controls": `body_${name}`, onclick: () => chosen(name), onkeydown: (event) => this.key(event, name) }, title);
      if (count !== undefined) tab.append(h("span.badge", null, String(count)));
      const body = h("div.tab_body", { role: "tabpanel", id: `body_${name}`, "aria-labelledby": `tab_${name}`, hidden: true, tabindex: "-1" });
      this.parts.set(name, { tab, body, is_made: false });
      this.bar.append(tab);
      this.body.append(body);
    }
  }

  has(name) {
    return this.parts.has(name);
  }

  show(wanted) {
    for (const { name, make } of this.list) {
      const part = this.parts.get(name), is_shown = name === wanted;
      part.tab.setAttribute("aria-selected", String(is_shown));
      part.tab.tabIndex = is_shown ? 0 : -1;
      part.body.hidden = !is_shown;
      if (is_shown && !part.is_made) {
        part.is_made = true;
        append(part.body, [make()]);
      }
    }
  }

  key(event, name) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const at = this.list.findIndex((entry) => entry.name === name);
    const next = this.list[(at + step + this.list.length) % this.list.length].name;
    this.chosen(next);
    this.parts.get(next).tab.focus();
  }
}
