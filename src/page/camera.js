// Cameras that orbit a point, upright: plain values, and functions that make new ones of them.
// Matrices are arrays of 16 numbers, column by column, as WebGL takes them.
{
  const STEEPEST = 0.4999 * Math.PI;

  const add = (a, b) => a.map((x, i) => x + b[i]);
  const subtract = (a, b) => a.map((x, i) => x - b[i]);
  const scale = (a, factor) => a.map((x) => x * factor);
  const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const normalised = (a) => scale(a, 1 / (Math.hypot(...a) || 1));
  const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

  // An orbit that begins at a camera `{eye, target, up, fov}` of the scene. It turns about the point
  // that is straight ahead and as far away as the middle of `box`, so that dragging turns the room
  // and not the eye, wherever the camera's target is.
  function orbit({ eye, target, up, fov }, box) {
    const ahead = normalised(subtract(target, eye));
    const distance = Math.max(dot(subtract(box.centre, eye), ahead), 0.1 * box.radius);
    const back = scale(ahead, -1);
    // Looking straight up or down, only the upper edge of the picture knows where the front is.
    const steep = Math.hypot(back[0], back[2]) < 1e-6;
    const level = steep ? scale(up, -Math.sign(back[1])) : back;
    return {
      target: add(eye, scale(ahead, distance)),
      distance,
      azimuth: Math.atan2(level[0], level[2]),
      elevation: clamp(Math.asin(clamp(back[1], -1, 1)), -STEEPEST, STEEPEST),
      fov,
    };
  }

  // Unit vectors to the right, up and back of an orbit's picture.
  function axes({ azimuth, elevation }) {
    const back = [
      Math.sin(azimuth) * Math.cos(elevation),
      Math.sin(elevation),
      Math.cos(azimuth) * Math.cos(elevation),
    ];
    const right = [Math.cos(azimuth), 0, -Math.sin(azimuth)];
    return { right, up: cross(back, right), back };
  }

  // Turned by angles, radians.
  function turned(view, right, up) {
    const elevation = clamp(view.elevation + up, -STEEPEST, STEEPEST);
    return { ...view, azimuth: view.azimuth + right, elevation };
  }

  // Moved across the picture by shares of its height.
  function shifted(view, right, up) {
    const height = 2 * view.distance * Math.tan(view.fov / 2);
    const { right: x, up: y } = axes(view);
    return { ...view, target: add(view.target, add(scale(x, right * height), scale(y, up * height))) };
  }

  // The distance multiplied by `factor`, within what `box` allows.
  function zoomed(view, factor, box) {
    return { ...view, distance: clamp(view.distance * factor, 0.02 * box.radius, 20 * box.radius) };
  }

  // World to clip space, for a picture of this width over height; depth spans the box tightly.
  function matrix(view, aspect, box) {
    const { right, up, back } = axes(view);
    const eye = add(view.target, scale(back, view.distance));
    const away = Math.hypot(...subtract(box.centre, eye));
    const near = Math.max(away - 1.01 * box.radius, 1e-3 * box.radius);
    const far = Math.max(away + 1.01 * box.radius, 2 * near);
    const y = 1 / Math.tan(view.fov / 2);
    const z = (near + far) / (near - far);
    const rows = [
      [...scale(right, y / aspect), (-dot(right, eye) * y) / aspect],
      [...scale(up, y), -dot(up, eye) * y],
      [...scale(back, z), -dot(back, eye) * z + (2 * near * far) / (near - far)],
      [...scale(back, -1), dot(back, eye)],
    ];
    return [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));
  }

  radiosity.camera = { orbit, turned, shifted, zoomed, matrix };
}
