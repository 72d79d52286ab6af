// What colours stand for: bars with marks, and swatches.
{
  const { element, short } = radiosity;
  const MOST_MARKS = 9;

  const css = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;

  // The colour at a place, 0..=1, of a map of 256 colours.
  function at(map, place) {
    const first = 3 * Math.round(255 * Math.min(Math.max(place, 0), 1));
    return [...map.subarray(first, first + 3)];
  }

  // Round values between two positive ends: 1, 2 and 5 of every decade, or if those are many, 1 alone.
  function logarithmicMarks(low, high) {
    const marks = (digits) => {
      const found = [];
      for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; power += 1) {
        for (const digit of digits) found.push(digit * 10 ** power);
      }
      return found.filter((mark) => mark >= low * 0.999 && mark <= high * 1.001);
    };
    const dense = marks([1, 2, 5]);
    return dense.length <= MOST_MARKS ? dense : marks([1]);
  }

  // A bar of colours with marks `[[place, text], ...]` under it.
  function bar(title, map, marks) {
    const stops = Array.from({ length: 17 }, (_, i) => css(at(map, i / 16)));
    const strip = element("div", { class: "strip" });
    strip.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
    const labels = marks.map(([place, text]) => {
      const mark = element("span", {}, text);
      mark.style.left = `${100 * place}%`;
      return mark;
    });
    return [element("span", { class: "title" }, title), element("div", { class: "bar" }, strip, element("div", { class: "marks" }, ...labels))];
  }

  function logarithmic(title, map, [low, high]) {
    const place = (value) => Math.log(value / low) / Math.log(high / low);
    return bar(title, map, logarithmicMarks(low, high).map((mark) => [place(mark), short(mark)]));
  }

  // From -limit to +limit, shares told in per cent.
  function diverging(title, map, limit) {
    const percent = (share) => `${share > 0 ? "+" : ""}${short(100 * share)} %`.replace("-", "\u2212");
    return bar(title, map, [-1, -0.5, 0, 0.5, 1].map((part) => [(part + 1) / 2, percent(part * limit)]));
  }

  // Colours with names, `[[colour, name], ...]`.
  function swatches(title, entries) {
    const swatch = ([colour, name]) => {
      const patch = element("i", {});
      patch.style.background = css(colour);
      return element("li", {}, patch, name);
    };
    return [element("span", { class: "title" }, title), element("ul", { class: "swatches" }, ...entries.map(swatch))];
  }

  function words(text) {
    return [element("span", { class: "title" }, text)];
  }

  radiosity.legend = { at, logarithmic, diverging, swatches, words };
}
