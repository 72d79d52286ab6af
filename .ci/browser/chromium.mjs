// Chromium without a window, driven by its DevTools protocol over a pipe: no packages needed.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const FLAGS = [
  "--headless=new",
  "--remote-debugging-pipe",
  "--no-sandbox", // root may not use the sandbox
  "--disable-dev-shm-usage", // containers have little of it
  "--no-first-run",
  "--disable-extensions",
  "--disable-background-networking",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--force-device-scale-factor=1",
];
const PATIENCE = 60_000; // ms for an answer

export class Browser {
  constructor(program = process.env.CHROMIUM ?? "chromium") {
    this.profile = mkdtempSync(join(tmpdir(), "radiosity-browser-"));
    const flags = [...FLAGS, `--user-data-dir=${this.profile}`, "about:blank"];
    // The protocol goes in by 3 and out by 4.
    this.child = spawn(program, flags, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    this.waiting = new Map();
    this.pages = new Map();
    this.sent = 0;
    this.failure = new Promise((_, reject) => {
      this.child.on("error", reject);
      this.child.on("exit", () => reject(new Error("the browser has ended")));
    });
    this.failure.catch(() => {});
    this.listen();
  }

  listen() {
    let rest = Buffer.alloc(0);
    this.child.stdio[4].on("data", (bytes) => {
      rest = Buffer.concat([rest, bytes]);
      for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
        this.receive(JSON.parse(rest.subarray(0, end).toString()));
        rest = rest.subarray(end + 1);
      }
    });
  }

  receive(message) {
    if (message.id === undefined) {
      this.pages.get(message.sessionId)?.event(message.method, message.params);
      return;
    }
    const { resolve, reject } = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) reject(new Error(message.error.message));
    else resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = (this.sent += 1);
    const answer = new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
    this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return withPatience(Promise.race([answer, this.failure]), method);
  }

  // A page of this width that has read the file at `path`, or what is at an address, whose origin it may
  // then ask for more; `prepare` may send what must come before.
  async open(path, { width = 1280, height = 900, prepare = async () => {} } = {}) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const address = path instanceof URL ? path : pathToFileURL(path);
    const page = new Page(this, sessionId, targetId, address.origin);
    this.pages.set(sessionId, page);
    for (const domain of ["Page", "Runtime", "Network", "Log"]) await page.send(`${domain}.enable`);
    const size = { width, height, deviceScaleFactor: 1, mobile: false };
    await page.send("Emulation.setDeviceMetricsOverride", size);
    await prepare(page);
    const loaded = page.next("Page.loadEventFired");
    await page.send("Page.navigate", { url: address.href });
    await loaded;
    return page;
  }

  async close() {
    const ended = new Promise((resolve) => this.child.once("exit", resolve));
    await this.send("Browser.close").catch(() => this.child.kill());
    await ended;
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

export class Page {
  constructor(browser, session, target, origin) {
    Object.assign(this, { browser, session, target, origin });
    this.complaints = [];
    this.listeners = new Map();
  }

  send(method, params) {
    return this.browser.send(method, params, this.session);
  }

  next(method) {
    const heard = new Promise((resolve) => this.listeners.set(method, resolve));
    return withPatience(heard, method);
  }

  // Whatever a page should not do is remembered.
  event(method, params) {
    this.listeners.get(method)?.(params);
    this.listeners.delete(method);
    if (method === "Runtime.exceptionThrown") {
      const { text, exception } = params.exceptionDetails;
      this.complaints.push(`exception: ${exception?.description ?? text}`);
    } else if (method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(params.type)) {
      this.complaints.push(`console: ${params.args.map((arg) => arg.value ?? arg.description).join(" ")}`);
    } else if (method === "Log.entryAdded" && ["error", "warning"].includes(params.entry.level)) {
      this.complaints.push(`log: ${params.entry.text}`);
    } else if (method === "Network.requestWillBeSent" && !this.mayAskFor(params.request.url)) {
      this.complaints.push(`request: ${params.request.url}`);
    }
  }

  mayAskFor(address) {
    return /^(file|data|blob):/.test(address) || new URL(address).origin === this.origin;
  }

  // What `action` returns when called with these values in the page.
  async evaluate(action, ...values) {
    const expression = `(${action})(...${JSON.stringify(values)})`;
    const answer = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (answer.exceptionDetails) {
      throw new Error(answer.exceptionDetails.exception?.description ?? answer.exceptionDetails.text);
    }
    return answer.result.value;
  }

  // Drags from one point of the view to another.
  async drag([x, y], [toX, toY]) {
    const mouse = (type, at, more) =>
      this.send("Input.dispatchMouseEvent", { type, x: at[0], y: at[1], button: "left", ...more });
    await mouse("mousePressed", [x, y], { buttons: 1, clickCount: 1 });
    for (const share of [0.25, 0.5, 0.75, 1]) {
      await mouse("mouseMoved", [x + share * (toX - x), y + share * (toY - y)], { buttons: 1 });
    }
    await mouse("mouseReleased", [toX, toY], { buttons: 0, clickCount: 1 });
  }

  wheel([x, y], pixels) {
    return this.send("Input.dispatchMouseEvent", { type: "mouseWheel", x, y, deltaX: 0, deltaY: pixels });
  }

  async press(key) {
    for (const type of ["keyDown", "keyUp"]) await this.send("Input.dispatchKeyEvent", { type, key });
  }

  // A PNG of the whole page.
  async screenshot() {
    const { data } = await this.send("Page.captureScreenshot", { format: "png", captureBeyondViewport: true });
    return Buffer.from(data, "base64");
  }

  close() {
    return this.browser.send("Target.closeTarget", { targetId: this.target });
  }
}

function withPatience(promise, what) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`no answer to ${what} in ${PATIENCE / 1000} s`)), PATIENCE);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}
