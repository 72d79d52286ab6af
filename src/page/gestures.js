// What hands do to a picture: drag, pinch, wheel and keys, told as turns, shifts and zooms.
{
  const TURN = 4; // radians for a drag across the height of the picture
  const KEY_TURN = Math.PI / 24;
  const KEY_ZOOM = 0.85;
  const WHEEL_ZOOM = 0.0012; // e-folds of distance for a pixel of wheel

  const KEYS = {
    ArrowLeft: (act) => act.turn(-KEY_TURN, 0),
    ArrowRight: (act) => act.turn(KEY_TURN, 0),
    ArrowUp: (act) => act.turn(0, KEY_TURN),
    ArrowDown: (act) => act.turn(0, -KEY_TURN),
    "+": (act) => act.zoom(KEY_ZOOM),
    "=": (act) => act.zoom(KEY_ZOOM), // the same key without shift
    "-": (act) => act.zoom(1 / KEY_ZOOM),
    0: (act) => act.reset(),
  };

  // Middle and spread of the pointers that are down.
  function grip(pointers) {
    const all = [...pointers.values()];
    const mean = (axis) => all.reduce((sum, p) => sum + p[axis], 0) / all.length;
    const middle = { x: mean("x"), y: mean("y") };
    const spread = all.reduce((sum, p) => sum + Math.hypot(p.x - middle.x, p.y - middle.y), 0);
    return { ...middle, spread };
  }

  // One pointer turns, or shifts with the shift key or another button; two shift and zoom.
  function drag(canvas, act) {
    const pointers = new Map();
    const place = (event) => ({ x: event.clientX, y: event.clientY });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, place(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!pointers.has(event.pointerId)) return;
      const before = grip(pointers);
      pointers.set(event.pointerId, place(event));
      const after = grip(pointers);
      const height = canvas.clientHeight || 1;
      const [x, y] = [(after.x - before.x) / height, (after.y - before.y) / height];
      const shifts = pointers.size > 1 || event.shiftKey || (event.buttons & 1) === 0;
      if (shifts) act.shift(-x, y);
      else act.turn(-x * TURN, y * TURN);
      if (before.spread > 0 && after.spread > 0) act.zoom(before.spread / after.spread);
    });
    const up = (event) => pointers.delete(event.pointerId);
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  function listen(canvas, act) {
    drag(canvas, act);
    canvas.addEventListener("dblclick", () => act.reset());
    canvas.addEventListener("wheel", wheel, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in KEYS)) return;
      event.preventDefault();
      KEYS[event.key](act);
    });
    function wheel(event) {
      event.preventDefault();
      const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 20 : 1);
      act.zoom(Math.exp(pixels * WHEEL_ZOOM));
    }
  }

  radiosity.gestures = { listen };
}
