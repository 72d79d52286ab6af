// Pictures on top of each other: the left part shows one, the right part another.
{
  const { element } = radiosity;
  const KEY_STEP = 0.02;

  class Wipe {
    constructor(figure) {
      this.stage = figure.querySelector(".stage");
      this.panes = [...figure.querySelectorAll(".pane")];
      this.state = { left: 0, right: this.panes.length - 1, at: 0.5 };
      this.line = element("div", { class: "line", role: "slider", tabindex: 0, "aria-label": "Border between the pictures", "aria-valuemin": 0, "aria-valuemax": 100 });
      this.stage.append(this.line);
      this.stage.after(this.controls());
      // Enlarged, pictures would be blurred.
      this.stage.style.maxWidth = `${figure.querySelector("img").getAttribute("width")}px`;
      figure.classList.add("live");
      this.listen();
      this.change({});
    }

    controls() {
      const names = this.panes.map((pane, i) => [String(i), pane.querySelector(".name").textContent]);
      const row = element("div", { class: "controls" });
      if (names.length > 2) {
        this.sides = ["left", "right"].map((side) => {
          const choice = radiosity.choice(`Picture on the ${side}`, names, (key) => this.change({ [side]: Number(key) }));
          row.append(element("span", { class: "side" }, side === "left" ? "Left" : "Right", choice.row));
          return [side, choice];
        });
      }
      const meshes = this.stage.querySelectorAll(".mesh");
      if (meshes.length > 0) row.append(radiosity.toggle("Mesh", (on) => this.stage.classList.toggle("meshed", on)).row);
      return row;
    }

    listen() {
      const follow = (event) => {
        const { left, width } = this.stage.getBoundingClientRect();
        this.change({ at: (event.clientX - left) / width });
      };
      this.stage.addEventListener("pointerdown", (event) => {
        this.stage.setPointerCapture(event.pointerId);
        follow(event);
      });
      this.stage.addEventListener("pointermove", (event) => event.buttons & 1 && follow(event));
      this.line.addEventListener("keydown", (event) => {
        const steps = { ArrowLeft: -KEY_STEP, ArrowRight: KEY_STEP, Home: -1, End: 1 };
        if (!(event.key in steps)) return;
        event.preventDefault();
        this.change({ at: this.state.at + steps[event.key] });
      });
    }

    change(changes) {
      Object.assign(this.state, changes);
      const { left, right } = this.state;
      const at = Math.min(Math.max(this.state.at, 0), 1);
      this.state.at = at;
      this.panes.forEach((pane, i) => {
        // The same picture on both sides is whole.
        pane.classList.toggle("left", i === left);
        pane.classList.toggle("right", i === right);
      });
      this.stage.style.setProperty("--at", `${100 * at}%`);
      this.line.setAttribute("aria-valuenow", Math.round(100 * at));
      for (const [side, choice] of this.sides ?? []) choice.show(String(this.state[side]));
    }
  }

  for (const figure of document.querySelectorAll("figure.wipe")) {
    if (figure.querySelectorAll(".pane").length > 1) new Wipe(figure);
  }
}
