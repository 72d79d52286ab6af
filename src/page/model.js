// A mesh as the page carries it, unpacked for drawing: corners in a row, three to a triangle.
{
  const littleEndian = (bytes, list) => new list(bytes.buffer, 0, bytes.length / list.BYTES_PER_ELEMENT);

  // Linear RGB, W/m², of 9 bits a channel over a shared exponent of 5; `unit` is what 1 stands for.
  function unpack(packed, unit) {
    const colours = new Float32Array(3 * packed.length);
    packed.forEach((bits, i) => {
      const step = unit * 2 ** ((bits >>> 27) - 24);
      colours[3 * i] = (bits & 511) * step;
      colours[3 * i + 1] = ((bits >>> 9) & 511) * step;
      colours[3 * i + 2] = ((bits >>> 18) & 511) * step;
    });
    return colours;
  }

  // The `width` numbers of every vertex, for each corner anew.
  function expanded(corners, values, width) {
    const all = new values.constructor(corners.length * width);
    corners.forEach((vertex, i) => {
      for (let k = 0; k < width; k += 1) all[i * width + k] = values[vertex * width + k];
    });
    return all;
  }

  // A step `{low, size, unit, wide, errorStep, lists}` of a viewer, its lists out of `chunks`.
  function decode(step, chunks) {
    const list = (name, type) =>
      step.lists[name] === undefined ? null : littleEndian(radiosity.bytes(chunks[step.lists[name]]), type);
    const corners = list("corners", step.wide ? Uint32Array : Uint16Array);
    const [levels, reasons] = [list("levels", Uint8Array), list("reasons", Uint8Array)];
    const errors = list("errors", Int16Array);
    const uvs = list("uvs", Float32Array);
    const leaves = new Uint8Array(2 * corners.length);
    for (let i = 0; levels && i < corners.length; i += 1) {
      leaves[2 * i] = levels[Math.floor(i / 3)];
      leaves[2 * i + 1] = reasons[Math.floor(i / 3)];
    }
    return {
      low: step.low,
      size: step.size,
      count: corners.length,
      positions: expanded(corners, list("positions", Uint16Array), 3),
      radiosity: expanded(corners, unpack(list("radiosity", Uint32Array), step.unit), 3),
      leaves,
      // Only with pictures on surfaces, which radiosity is then to be multiplied by.
      uvs: uvs && expanded(corners, uvs, 2),
      runs: step.runs ?? [{ corners: corners.length, picture: null }],
      errors: expanded(corners, errors ?? new Int16Array(step.vertices), 1),
      errorStep: step.errorStep,
      reasons: [...new Set(reasons ?? [])].sort((a, b) => a - b),
    };
  }

  radiosity.model = { decode };
}
