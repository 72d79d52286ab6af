// The one name that the scripts of a page share, and small helpers for all of them.
//
// The files are joined into one script, this one first, the component's own files after it. Each
// keeps its names in a block and hands out what others need as a member of `radiosity`.
"use strict";

const radiosity = {};

{
  // An element with attributes, listeners ("onclick": f) and children; false and null are left out.
  function element(name, attributes = {}, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
      else if (value !== false && value !== null) made.setAttribute(key, value === true ? "" : value);
    }
    made.append(...children.filter((child) => child !== null));
    return made;
  }

  let choices = 0;

  // A row of radio buttons that looks like one switch; `choose` gets the key of the one picked.
  // `show(key)` marks a choice without telling anyone.
  function choice(label, options, choose) {
    const name = `choice-${(choices += 1)}`;
    const inputs = new Map();
    const buttons = options.map(([key, text]) => {
      const input = element("input", { type: "radio", name, value: key, onchange: () => choose(key) });
      inputs.set(key, input);
      return element("label", {}, input, element("span", {}, text));
    });
    const row = element("div", { class: "choice", role: "radiogroup", "aria-label": label }, ...buttons);
    return { row, show: (key) => inputs.has(key) && (inputs.get(key).checked = true) };
  }

  // A check box with its label.
  function toggle(label, change) {
    const input = element("input", { type: "checkbox", onchange: () => change(input.checked) });
    return { row: element("label", { class: "toggle" }, input, label), input };
  }

  // A number for people: three digits that count, no zeros behind.
  function short(value) {
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size < 1e-3 || size >= 1e6) return String(Number(value.toPrecision(3)));
    return String(Number(value.toFixed(Math.max(0, 2 - Math.floor(Math.log10(size))))));
  }

  // The bytes of a base64 text.
  function bytes(base64) {
    const text = atob(base64);
    return Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  }

  Object.assign(radiosity, { element, choice, toggle, short, bytes });
}
