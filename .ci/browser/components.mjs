// What each component of a page must do, tried by hand in a browser.

// Helpers for what runs in the page.
export const HELPERS = `
  window.part = (kind, number, selector) => document.querySelectorAll("figure." + kind)[number].querySelector(selector);
  window.parts = (kind, number, selector) => [...document.querySelectorAll("figure." + kind)[number].querySelectorAll(selector)];
  window.frame = () => new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));`;

export function must(holds, what) {
  if (!holds) throw new Error(what);
}

// The picture of a viewer, once it is drawn: a text, the same for the same picture.
const canvas = (page, viewer) =>
  page.evaluate(async (number) => {
    await frame();
    await frame();
    return part("viewer", number, "canvas").toDataURL();
  }, viewer);

const click = (page, kind, number, selector, which = 0) =>
  page.evaluate((...at) => parts(...at.slice(0, 3))[at[3]].click(), kind, number, selector, which);

const count = (page, kind, number, selector) =>
  page.evaluate((...at) => parts(...at).length, kind, number, selector);

// Where something is in the view, which is scrolled to it.
const place = (page, kind, number, selector) =>
  page.evaluate((...at) => {
    part(...at).scrollIntoView({ block: "center" });
    const { left, top, width, height } = part(...at).getBoundingClientRect();
    return { left, width, x: left + width / 2, y: top + height / 2 };
  }, kind, number, selector);

// Most that the mean light of a viewer without what lies on its surfaces may be from that with it, as a share: what is
// seen of a picture is not all of it, and where it is dark the tone curve takes less off.
const CHANGED = 0.15;

// Most that the channels of a viewer's light may be from those of its still picture, our own PNG of the same view, on
// average where that is not black, as it is beyond the scene and on backs; of 255. Edges are smoothed otherwise.
const FAR = 1;

// How far a viewer's drawing is from its still picture, and their mean light; nothing without a still picture.
const fromStill = async (page, viewer) => {
  await canvas(page, viewer);
  return page.evaluate((number) => {
    const still = part("viewer", number, ".still img");
    const shown = part("viewer", number, "canvas");
    if (!still) return null;
    const [width, height] = [still.naturalWidth, still.naturalHeight];
    // A view is as high as another; the wider one has more at its sides.
    const whole = shown.height * (width / height);
    const copied = (source, left, across, down) => {
      const copy = new OffscreenCanvas(width, height).getContext("2d");
      copy.fillRect(0, 0, width, height);
      copy.drawImage(source, left, 0, across, down, 0, 0, width, height);
      return copy.getImageData(0, 0, width, height).data.filter((_, i) => i % 4 < 3);
    };
    const all = copied(still, 0, width, height);
    const isLit = (_, i) => all.subarray(i - (i % 3), i - (i % 3) + 3).some((x) => x > 0);
    const ours = all.filter(isLit);
    const theirs = copied(shown, (shown.width - whole) / 2, whole, shown.height).filter(isLit);
    const mean = (values, what) => values.reduce((sum, x, i) => sum + what(x, i), 0) / values.length;
    const linear = (code) => (code / 255) ** 2.2;
    return { far: mean(ours, (x, i) => Math.abs(x - theirs[i])), light: [mean(ours, linear), mean(theirs, linear)] };
  }, viewer);
};

// The light is that of our own picture, and what lies on surfaces can be taken away and put back.
async function pictured(page, number) {
  const first = await fromStill(page, number);
  if (!first) return;
  must(first.far < FAR, `light is ${first.far.toFixed(2)} of 255 from the still picture`);
  const toggles = await page.evaluate((n) => parts("viewer", n, ".toggle").map((toggle) => toggle.textContent), number);
  const textures = toggles.indexOf("Textures");
  if (textures < 0) return;
  const before = await canvas(page, number);
  await click(page, "viewer", number, ".toggle input", textures);
  const plain = await fromStill(page, number);
  must(plain.far > first.far + 1, `without its pictures a surface is ${plain.far.toFixed(2)} of 255 from what it is with them`);
  const [still, alone] = plain.light;
  must(Math.abs(alone / still - 1) < CHANGED, `light alone is ${(alone / still).toFixed(2)} times that of the still picture`);
  await click(page, "viewer", number, ".toggle input", textures);
  must((await canvas(page, number)) === before, "pictures on surfaces do not come back");
}

// Every mode, the mesh over it, the sliders, dragging and keys change the picture.
export async function viewer(page, number) {
  const modes = await count(page, "viewer", number, ".choice input");
  must(modes >= 2, "the viewer has no modes");
  const seen = new Set();
  for (let mode = 0; mode < modes; mode += 1) {
    await click(page, "viewer", number, ".choice input", mode);
    const plain = await canvas(page, number);
    must(!seen.has(plain), `mode ${mode} looks like another`);
    // Within a room, all that is seen of a uniform mesh may have one level and one reason.
    must((await colours(page, number)) >= (mode < 2 ? 3 : 1), `mode ${mode} shows nothing`);
    must(await page.evaluate((n) => part("viewer", n, ".legend").textContent !== "", number), `mode ${mode} has no legend`);
    await click(page, "viewer", number, ".toggle input");
    must((await canvas(page, number)) !== plain, `the mesh changes nothing in mode ${mode}`);
    await click(page, "viewer", number, ".toggle input");
    must((await canvas(page, number)) === plain, `mode ${mode} is not what it was without the mesh`);
    seen.add(plain);
  }
  await click(page, "viewer", number, ".choice input", 0);
  await pictured(page, number);
  await sliders(page, number);
  await movement(page, number);
}

const colours = (page, viewer) =>
  page.evaluate((number) => {
    const shown = part("viewer", number, "canvas");
    const copy = new OffscreenCanvas(shown.width, shown.height).getContext("2d");
    copy.drawImage(shown, 0, 0);
    const { data } = copy.getImageData(0, 0, shown.width, shown.height);
    return new Set(new Uint32Array(data.buffer)).size;
  }, viewer);

async function sliders(page, number) {
  const own = ".slider:not([hidden]) input";
  const slide = (slider, to) =>
    page.evaluate((n, selector, which, value) => {
      const input = parts("viewer", n, selector)[which];
      const before = input.value;
      input.value = value ?? input.min;
      input.dispatchEvent(new Event("input"));
      return before;
    }, number, own, slider, to);
  for (let slider = 0; slider < (await count(page, "viewer", number, own)); slider += 1) {
    const before = await canvas(page, number);
    const value = await slide(slider, null);
    must((await canvas(page, number)) !== before, `slider ${slider} changes nothing`);
    await slide(slider, value);
    must((await canvas(page, number)) === before, `slider ${slider} does not come back`);
  }
}

async function movement(page, number) {
  const home = await canvas(page, number);
  const { x, y, width } = await place(page, "viewer", number, "canvas");
  await page.drag([x, y], [x + width / 5, y + 20]);
  const turned = await canvas(page, number);
  must(turned !== home, "dragging turns nothing");
  await page.press("+");
  const nearer = await canvas(page, number);
  must(nearer !== turned, "the plus key does not zoom");
  await page.wheel([x, y], 240);
  must((await canvas(page, number)) !== nearer, "the wheel does not zoom");
  await page.press("ArrowLeft");
  await page.press("0");
  must((await canvas(page, number)) === home, "the 0 key does not go back");
}

// Viewers of a group move together.
export async function linked(page) {
  const groups = await page.evaluate(() => [...document.querySelectorAll("figure.viewer")].map((figure) => figure.dataset.group));
  for (const [first, group] of groups.entries()) {
    const second = groups.indexOf(group, first + 1);
    if (second < 0) continue;
    const before = await canvas(page, second);
    const { x, y, width } = await place(page, "viewer", first, "canvas");
    await page.drag([x, y], [x + width / 6, y]);
    must((await canvas(page, second)) !== before, `viewer ${second} does not follow viewer ${first}`);
    await page.press("0");
    must((await canvas(page, second)) === before, `viewer ${second} does not go back with viewer ${first}`);
  }
}

// Nothing is drawn while nothing changes.
export async function idle(page) {
  const drawn = () => page.evaluate(() => window.drawn);
  await canvas(page, 0);
  const before = await drawn();
  await new Promise((resolve) => setTimeout(resolve, 300));
  must(before > 0 && (await drawn()) === before, "a viewer draws although nothing changes");
}

// A lost graphics card is told, and a new one is used.
export async function lost(page) {
  const before = await canvas(page, 0);
  const toldAfter = (action) =>
    page.evaluate(async (name) => {
      window.lost ??= part("viewer", 0, "canvas").getContext("webgl2").getExtension("WEBGL_lose_context");
      window.lost[name]();
      await new Promise((resolve) => setTimeout(resolve, 100));
      return part("viewer", 0, ".message").checkVisibility();
    }, action);
  must(await toldAfter("loseContext"), "a lost context has no message");
  must(!(await toldAfter("restoreContext")), "the message stays when the context is back");
  must((await canvas(page, 0)) === before, "the picture is another after a lost context");
}

export async function wipe(page, number) {
  const border = () => page.evaluate((n) => part("wipe", n, ".stage").style.getPropertyValue("--at"), number);
  const picture = async () => (await page.screenshot()).toString("base64");
  const { left, width, x, y } = await place(page, "wipe", number, ".stage");
  const [before, at] = [await picture(), await border()];
  await page.drag([x, y], [left + width / 5, y]);
  must((await border()) !== at, "the border does not move");
  const moved = await picture();
  must(moved !== before, "the pictures do not change with the border");
  for (const selector of [".toggle input", ".choice label:nth-child(2) input"]) {
    if ((await count(page, "wipe", number, selector)) === 0) continue;
    await click(page, "wipe", number, selector);
    must((await picture()) !== moved, `${selector} changes nothing in the pictures`);
  }
}

export async function table(page, number) {
  const columns = await count(page, "table", number, "thead th");
  for (let column = 0; column < columns; column += 1) {
    const [rising, falling] = [await sorted(page, number, column), await sorted(page, number, column)];
    must(rising.sort === "ascending" && falling.sort === "descending", "a sorted table does not say so");
    const [up, down] = [rising, falling].map(({ values }) => values.map(Number));
    if (!up.every(Number.isFinite)) continue;
    must(isRising(up) && isRising(down.reverse()), `column ${column} is not sorted: ${up}; ${down}`);
  }
  const csv = await csvOf(page, number);
  must(csv !== null && csv.split("\r\n").length > 2, `the CSV is no table: ${csv}`);
}

const sorted = (page, table, column) =>
  page.evaluate((number, at) => {
    const header = parts("table", number, "thead th")[at];
    header.querySelector("button").click();
    const cells = parts("table", number, "tbody tr").map((row) => row.cells[at]);
    return { sort: header.getAttribute("aria-sort"), values: cells.map((cell) => cell.dataset.value ?? cell.textContent) };
  }, table, column);

const isRising = (numbers) => numbers.every((value, i) => i === 0 || numbers[i - 1] <= value);

// What would be saved.
const csvOf = (page, table) =>
  page.evaluate(async (number) => {
    const blobs = [];
    const make = URL.createObjectURL;
    URL.createObjectURL = (blob) => blobs.push(blob) && make.call(URL, blob);
    const { click } = HTMLAnchorElement.prototype;
    HTMLAnchorElement.prototype.click = () => {}; // no file is wanted here
    part("table", number, ".controls button").click();
    URL.createObjectURL = make;
    HTMLAnchorElement.prototype.click = click;
    return blobs.length === 1 ? await blobs[0].text() : null;
  }, table);
