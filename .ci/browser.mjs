// Tries HTML pages in Chromium: node browser.mjs [--screenshots DIRECTORY] FILE.html ...
// Whatever components a page has are tried, with scripts, without, and without WebGL. One line per
// file; exit status 1 if any page fails, 2 on wrong usage. $CHROMIUM names another program.

import { mkdirSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

import { Browser } from "./browser/chromium.mjs";
import * as components from "./browser/components.mjs";

const { HELPERS, must } = components;

const WIDTHS = [1280, 400];

// Before the page's scripts: what there is already, and a count of what is drawn.
const WATCH = `${HELPERS}
  window.drawn = 0;
  const drawArrays = WebGL2RenderingContext.prototype.drawArrays;
  WebGL2RenderingContext.prototype.drawArrays = function (...values) {
    window.drawn += 1;
    drawArrays.apply(this, values);
  };
  window.known = new Set([...Object.getOwnPropertyNames(window), "known"]);`;

const NO_WEBGL = "HTMLCanvasElement.prototype.getContext = () => null;";

const first = (source) => (page) => page.send("Page.addScriptToEvaluateOnNewDocument", { source });

const number = (page, selector) => page.evaluate((text) => document.querySelectorAll(text).length, selector);

async function withScripts(browser, path) {
  const page = await browser.open(path, { prepare: first(WATCH) });
  const leaked = await page.evaluate(() => Object.getOwnPropertyNames(window).filter((name) => !window.known.has(name)));
  must(leaked.length === 0, `the scripts leave names behind: ${leaked}`);
  const done = [];
  for (const kind of ["viewer", "wipe", "table"]) {
    const count = await number(page, `figure.${kind}`);
    for (let i = 0; i < count; i += 1) await components[kind](page, i);
    done.push(`${count} ${kind}${count === 1 ? "" : "s"}`);
  }
  if (await number(page, "figure.viewer")) {
    await components.linked(page);
    await components.idle(page);
    await components.lost(page);
  }
  must(page.complaints.length === 0, page.complaints.join("\n  "));
  await page.close();
  return done.join(", ");
}

// Texts and pictures are there all the same.
async function readable(browser, path, prepare, what) {
  const page = await browser.open(path, { prepare });
  const hidden = await page.evaluate(() => {
    const seen = (element) => element.checkVisibility() && element.getBoundingClientRect().height > 0;
    const missing = [...document.querySelectorAll("figure.wipe .plain img, .still img, figure.picture img")]
      .filter((image) => !seen(image) || image.naturalWidth === 0).map((image) => image.alt);
    const told = [...document.querySelectorAll("figure.viewer .stage")].filter((stage) => !stage.innerText.trim());
    return [...missing, ...told.map(() => "a message instead of the viewer")].concat(document.querySelector("h1") ? [] : "a heading");
  });
  must(hidden.length === 0, `${what}, these are missing: ${hidden}`);
  must(page.complaints.length === 0, `${what}: ${page.complaints.join("\n  ")}`);
  await page.close();
}

async function fits(browser, path, directory) {
  for (const width of WIDTHS) {
    const page = await browser.open(path, { width });
    const excess = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    must(excess <= 0, `the page is ${excess} pixels wider than a window of ${width}`);
    if (directory) await pictures(page, join(directory, `${basename(path, ".html")}-${width}`));
    await page.close();
  }
}

// The page as it is at first, in every mode of its viewers, and with the mesh.
async function pictures(page, name) {
  const settled = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50))));
  const shoot = async (what) => {
    await settled();
    writeFileSync(`${name}-${what}.png`, await page.screenshot());
  };
  await shoot("first");
  const modes = await page.evaluate(() => [...(document.querySelector("figure.viewer")?.querySelectorAll(".choice input") ?? [])].map((input) => input.value));
  for (const mode of modes) {
    await page.evaluate((value) => document.querySelector(`figure.viewer .choice input[value=${value}]`).click(), mode);
    await shoot(mode);
  }
  if (modes.length === 0) return;
  await page.evaluate(() => document.querySelector("figure.viewer .toggle input").click());
  await shoot("mesh");
}

async function check(browser, path, directory) {
  const done = await withScripts(browser, path);
  const scriptless = (page) => page.send("Emulation.setScriptExecutionDisabled", { value: true });
  await readable(browser, path, scriptless, "without scripts");
  await readable(browser, path, first(NO_WEBGL), "without WebGL");
  await fits(browser, path, directory);
  return done;
}

const [option, directory] = process.argv.slice(2);
const takesPictures = option === "--screenshots";
const paths = process.argv.slice(takesPictures ? 4 : 2);
if (paths.length === 0) {
  console.error("usage: node browser.mjs [--screenshots DIRECTORY] FILE.html ...");
  process.exit(2);
}
if (takesPictures) mkdirSync(directory, { recursive: true });
const browser = new Browser();
let allGood = true;
for (const path of paths) {
  try {
    console.log(`${path}: ${await check(browser, path, takesPictures ? directory : null)}`);
  } catch (error) {
    console.error(`${path}: ${error.message}`);
    allGood = false;
  }
}
await browser.close();
process.exit(allGood ? 0 : 1);
