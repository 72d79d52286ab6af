// Tries HTML pages in Chromium: node browser.mjs [--screenshots DIRECTORY] FILE.html ...
// Whatever components a page has are tried, with scripts, without, and without WebGL. One line per
// file; exit status 1 if any page fails, 2 on wrong usage. $CHROMIUM names another program.

import { mkdirSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

import { Browser } from "./browser/chromium.mjs";
import * as components from "./browser/components.mjs";

const { HELPERS, must } = components;

const WIDTHS = [1280, 390];
const SCHEMES = ["light", "dark"];

// Least contrast of letters, as WCAG 2 has it for ordinary text.
const CONTRAST = 4.5;

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

const inScheme = (value) => (page) =>
  page.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value }] });

// In both schemes, wide and narrow, all folded away or open.
async function fits(browser, path, directory) {
  for (const scheme of SCHEMES) {
    for (const width of WIDTHS) {
      const page = await browser.open(path, { width, prepare: inScheme(scheme) });
      await isNoWiderThan(page, width);
      await canBeRead(page, scheme);
      await leads(page);
      if (directory && scheme === "light") await pictures(page, join(directory, `${basename(path, ".html")}-${width}`));
      await page.evaluate(() => document.querySelectorAll("details").forEach((details) => { details.open = true; }));
      await isNoWiderThan(page, width);
      await page.close();
    }
  }
}

async function isNoWiderThan(page, width) {
  const excess = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  must(excess <= 0, `the page is ${excess} pixels wider than a window of ${width}`);
}

// Letters, those of charts too, stand out from the page.
async function canBeRead(page, scheme) {
  const faint = await page.evaluate((least) => {
    const light = (colour) => {
      const channels = colour.match(/[\d.]+/g).slice(0, 3).map((x) => x / 255);
      const [r, g, b] = channels.map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const paper = light(getComputedStyle(document.body).backgroundColor);
    const contrast = (ink) => (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
    const letters = [...document.querySelectorAll("h1, h2, h3, h4, p:not(.message), figcaption, td, th, nav a, .plot text")];
    const ink = (element) => getComputedStyle(element)[element.closest("svg") ? "fill" : "color"];
    return letters.filter((element) => !element.closest(".stage") && contrast(light(ink(element))) < least)
      .map((element) => `${element.localName} "${element.textContent.trim().slice(0, 30)}"`);
  }, CONTRAST);
  must(faint.length === 0, `${scheme}: these can hardly be read: ${faint.slice(0, 5)}`);
}

// Contents lead somewhere, and to every section.
async function leads(page) {
  const lost = await page.evaluate(() => {
    const links = [...document.querySelectorAll("nav a")].map((link) => link.getAttribute("href"));
    const nowhere = links.filter((href) => !document.querySelector(href));
    const sections = [...document.querySelectorAll("section")].map((section) => `#${section.id}`);
    return nowhere.concat(sections.filter((href) => !links.includes(href)));
  });
  must(lost.length === 0, `contents and sections do not match: ${lost}`);
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
