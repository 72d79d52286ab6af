// The 3D viewer: brings a model, a camera, a drawing and controls together. What the user changes is
// kept by a group, so that all viewers of a group look from one place at one quantity.
{
  const { element, short, bytes, camera, legend } = radiosity;

  const NAMES = { light: "Light", radiosity: "Radiosity", level: "Level", reason: "Reason", error: "Error" };
  const FINEST_DISPLAY = 2; // pixels of the canvas to one of the page, at most

  // The slider of a mode: which of the group's settings it moves, in powers of two, and what it says.
  const SLIDERS = {
    light: { key: "stops", name: "Exposure", reach: 8, say: (stops) => `${signed(stops)} stops` },
    radiosity: { key: "top", name: "Top of scale", reach: 6, say: (_, viewer) => `${short(viewer.ends()[1])} W/m²` },
    error: { key: "limit", name: "Ends of scale", reach: 6, say: (_, viewer) => `±${short(100 * viewer.ends()[1])} %` },
  };

  const signed = (number) => (number < 0 ? "\u2212" : "+") + Math.abs(number).toFixed(1);

  // What linked viewers share.
  class Group {
    constructor() {
      this.viewers = [];
      this.state = { view: null, mode: "light", mesh: false, textures: true, stops: 0, top: 0, limit: 0, step: null };
      // Scales fit all viewers: equal colours mean equal values.
      this.scale = { range: [Infinity, 0], limit: 0, deepest: 0 };
    }

    join(viewer, { range, errorLimit, deepest }) {
      this.viewers.push(viewer);
      this.scale.range = [Math.min(this.scale.range[0], range[0]), Math.max(this.scale.range[1], range[1])];
      this.scale.limit = Math.max(this.scale.limit, errorLimit);
      this.scale.deepest = Math.max(this.scale.deepest, deepest);
      this.state.view ??= viewer.home;
      for (const each of this.viewers) each.update();
    }

    change(changes) {
      Object.assign(this.state, changes);
      for (const viewer of this.viewers) viewer.update();
    }
  }

  class Viewer {
    constructor(figure, group) {
      this.figure = figure;
      this.group = group;
      this.data = JSON.parse(figure.querySelector("script").textContent);
      this.canvas = figure.querySelector("canvas");
      this.message = figure.querySelector(".message");
      this.maps = { viridis: bytes(this.data.viridis), diverging: bytes(this.data.diverging) };
      this.models = new Map();
      this.box = boxOf(this.data.steps);
      this.home = camera.orbit(this.data.camera, this.box);
      this.modes = Object.keys(NAMES).filter((mode) => this.data.modes.includes(mode));
      if (!this.start()) return;
      this.pictures = (this.data.pictures ?? []).map((picture) => this.read(picture));
      this.addControls();
      this.listen();
      group.join(this, this.data);
    }

    // False, with a message instead of the drawing, where there is no WebGL.
    start() {
      try {
        this.drawing = new radiosity.Drawing(this.canvas);
      } catch (error) {
        this.say(`This browser cannot draw in 3D: ${error.message}.`);
        return false;
      }
      this.drawn = { step: null, palette: null };
      this.figure.classList.add("live");
      this.say("");
      return true;
    }

    // A picture of a surface, whose image comes in its own time.
    read({ mime, chunk, ...picture }) {
      const image = new Image();
      image.onload = () => this.redraw();
      image.src = `data:${mime};base64,${this.data.chunks[chunk]}`;
      return { ...picture, image };
    }

    say(text) {
      this.message.textContent = text;
      this.message.hidden = text === "";
      if (text !== "") this.figure.classList.remove("live");
    }

    listen() {
      const { group } = this;
      const move = (change) => (...by) => group.change({ view: change(group.state.view, ...by, this.box) });
      radiosity.gestures.listen(this.canvas, {
        turn: move(camera.turned),
        shift: move(camera.shifted),
        zoom: move(camera.zoomed),
        reset: () => group.change({ view: this.home }),
      });
      new ResizeObserver(() => this.redraw()).observe(this.canvas);
      this.canvas.addEventListener("webglcontextlost", (event) => {
        event.preventDefault();
        this.say("The graphics card has dropped this drawing; it will be back when it can.");
      });
      this.canvas.addEventListener("webglcontextrestored", () => this.start() && this.redraw());
    }

    addControls() {
      const { group } = this;
      this.mode = radiosity.choice("What to show", this.modes.map((mode) => [mode, NAMES[mode]]), (mode) => group.change({ mode }));
      this.mesh = radiosity.toggle("Mesh", (mesh) => group.change({ mesh }));
      this.textures = radiosity.toggle("Textures", (textures) => group.change({ textures }));
      const reset = element("button", { type: "button", onclick: () => group.change({ view: this.home }) }, "Reset view");
      this.slider = slider((value) => group.change({ [SLIDERS[group.state.mode].key]: value }));
      this.steps = slider((step) => group.change({ step }));
      this.legend = element("div", { class: "legend" });
      const last = this.data.steps.length - 1;
      this.steps.set({ name: "Step", min: 0, max: last, step: 1 });
      const controls = element("div", { class: "controls" }, this.mode.row, this.mesh.row, this.pictures.length > 0 ? this.textures.row : null, reset, last > 0 ? this.steps.row : null);
      const scales = element("div", { class: "controls" }, this.legend, this.slider.row);
      this.figure.querySelector(".stage").after(controls, scales);
    }

    // The mode of the group, or light if this viewer lacks it.
    shownMode() {
      const { mode } = this.group.state;
      return this.modes.includes(mode) ? mode : "light";
    }

    shownStep() {
      const last = this.data.steps.length - 1;
      return Math.min(this.group.state.step ?? last, last);
    }

    // Values at the ends of the mode's scale.
    ends() {
      const { state, scale } = this.group;
      if (this.shownMode() === "error") {
        const limit = scale.limit * 2 ** state.limit;
        return [-limit, limit];
      }
      const [low, high] = scale.range;
      return [low, Math.max(high * 2 ** state.top, 1.5 * low)];
    }

    model(step) {
      if (!this.models.has(step)) {
        this.models.set(step, radiosity.model.decode(this.data.steps[step], this.data.chunks));
      }
      return this.models.get(step);
    }

    // Follows the group's state.
    update() {
      const { state } = this.group;
      const mode = this.shownMode();
      const step = this.shownStep();
      this.mode.show(mode);
      this.mesh.input.checked = state.mesh;
      this.textures.input.checked = state.textures;
      this.updateSlider(mode);
      this.steps.show(step, this.data.steps[step].label);
      this.updateLegend([mode, state.stops, step, ...this.ends(), this.group.scale.deepest].join());
      this.redraw();
    }

    updateSlider(mode) {
      const kind = SLIDERS[mode];
      this.slider.row.hidden = !kind;
      if (!kind) return;
      this.slider.set({ name: kind.name, min: -kind.reach, max: kind.reach, step: 0.1 });
      const value = this.group.state[kind.key];
      this.slider.show(value, kind.say(value, this));
    }

    updateLegend(key) {
      if (key === this.legendKey) return;
      this.legendKey = key;
      this.legend.replaceChildren(...this.legendOf(this.shownMode()));
    }

    legendOf(mode) {
      const { viridis, diverging } = this.maps;
      switch (mode) {
        case "radiosity":
          return legend.logarithmic("Radiosity, W/m²", viridis, this.ends());
        case "error":
          return legend.diverging("Error, share of the reference", diverging, this.ends()[1]);
        case "level":
          return legend.swatches("Level of elements", this.levels().map((colour, level) => [colour, String(level)]));
        case "reason": {
          const { reasons } = this.model(this.shownStep());
          return legend.swatches("Why elements were made", reasons.map((reason) => this.data.reasons[reason]));
        }
        default:
          return legend.words(`Exposure value ${(this.data.ev - this.group.state.stops).toFixed(1)} at ISO 100`);
      }
    }

    // Colours of the levels, the same in all of the group.
    levels() {
      const { deepest } = this.group.scale;
      return Array.from({ length: deepest + 1 }, (_, level) => legend.at(this.maps.viridis, level / Math.max(deepest, 1)));
    }

    // The 256 colours that a mode draws with.
    palette(mode) {
      if (mode === "error") return this.maps.diverging;
      if (mode === "light" || mode === "radiosity") return this.maps.viridis;
      const colours = mode === "level" ? this.levels() : this.data.reasons.map(([colour]) => colour);
      const all = new Uint8Array(768);
      all.set(colours.flat());
      return all;
    }

    // Draws before the next picture of the screen, however often it is asked to.
    redraw() {
      this.waiting ??= requestAnimationFrame(() => {
        this.waiting = null;
        this.draw();
      });
    }

    draw() {
      const { canvas, drawing } = this;
      if (drawing.gl.isContextLost() || canvas.clientWidth === 0) return;
      const pixel = Math.min(window.devicePixelRatio || 1, FINEST_DISPLAY);
      const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.round(side * pixel));
      if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
      const mode = this.shownMode();
      this.provide(this.shownStep(), mode);
      const { view, stops, mesh, textures } = this.group.state;
      const clip = camera.matrix(view, width / height, this.box);
      const exposure = this.data.exposure * 2 ** stops;
      drawing.draw({ clip, mode, exposure, ends: this.ends(), mesh, textures, pictures: this.pictures, pixel });
    }

    // Gives the graphics card what it does not have yet.
    provide(step, mode) {
      if (this.drawn.step !== step) this.drawing.setModel(this.model(step));
      const palette = `${mode} ${this.group.scale.deepest}`;
      if (this.drawn.palette !== palette) this.drawing.setPalette(this.palette(mode));
      this.drawn = { step, palette };
    }
  }

  // A slider with its name in front and what it says behind.
  function slider(change) {
    const input = element("input", { type: "range", oninput: () => change(Number(input.value)) });
    const [name, said] = [element("span", {}), element("output", {})];
    return {
      row: element("label", { class: "slider" }, name, input, said),
      set({ name: text, ...attributes }) {
        name.textContent = text;
        Object.assign(input, attributes);
      },
      show(value, text) {
        input.value = value;
        said.textContent = text;
        input.setAttribute("aria-valuetext", text);
      },
    };
  }

  // Middle and radius of a ball around all steps.
  function boxOf(steps) {
    const axes = [0, 1, 2];
    const low = axes.map((axis) => Math.min(...steps.map((step) => step.low[axis])));
    const high = axes.map((axis) => Math.max(...steps.map((step) => step.low[axis] + step.size[axis])));
    const centre = axes.map((axis) => (low[axis] + high[axis]) / 2);
    const radius = Math.hypot(...axes.map((axis) => high[axis] - low[axis])) / 2;
    return { centre, radius: radius || 1 };
  }

  const groups = new Map();
  for (const figure of document.querySelectorAll("figure.viewer")) {
    const name = figure.dataset.group;
    if (!groups.has(name)) groups.set(name, new Group());
    new Viewer(figure, groups.get(name));
  }
}
