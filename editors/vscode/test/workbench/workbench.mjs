// What a user does in VS Code.

const WAIT = { timeout: 30_000 };
const PALETTE_MS = 3_000;
const POLL_MS = 100;

export class Workbench {
  /** @param {import("puppeteer-core").Page} page */
  constructor(page) {
    this.page = page;
  }

  /**
   * @param {string} address
   * @param {string} folder
   */
  async open(address, folder) {
    await this.page.goto(`${address}?folder=${folder}`, { waitUntil: "domcontentloaded" });
    await this.page.waitForSelector(".explorer-folders-view .monaco-list-row", WAIT);
  }

  /**
   * Opens a file by a double click in the explorer.
   * @param {string} name
   */
  async openFile(name) {
    await this.page.locator(`.explorer-folders-view [aria-label="${name}"]`).click({ count: 2 });
    await this.page.waitForSelector(`.tab.active[data-resource-name="${name}"]`, WAIT);
  }

  /**
   * Runs a command of the palette. The palette lists what was there when it opened: soon after the start, it is opened
   * more than once.
   * @param {string} title
   */
  async run(title) {
    const end = Date.now() + WAIT.timeout;
    for (;;) {
      await this.page.keyboard.press("F1");
      await this.page.waitForSelector(".quick-input-widget:not([style*='display: none']) input", WAIT);
      await this.page.keyboard.type(title);
      try {
        await this.page.waitForSelector(`.quick-input-list .monaco-list-row.focused[aria-label^="${title}"]`, {
          timeout: PALETTE_MS,
        });
        break;
      } catch (error) {
        if (Date.now() > end) {
          throw error;
        }
        await this.page.keyboard.press("Escape");
      }
    }
    await this.page.keyboard.press("Enter");
  }

  /** @param {number} line */
  async goTo(line) {
    await this.run("Go to Line/Column");
    await this.page.keyboard.type(String(line));
    await this.page.keyboard.press("Enter");
    await this.statusHas(`Ln ${line}, `);
  }

  /** @param {string} text in the status bar */
  async statusHas(text) {
    await this.textIn(".part.statusbar", text);
  }

  /**
   * Waits for a text in a part of the window.
   * @param {string} selector
   * @param {string} text
   */
  async textIn(selector, text) {
    await this.page.waitForFunction(
      (where, what) =>
        [...document.querySelectorAll(where)].some((part) => part.textContent?.replaceAll("\u00a0", " ").includes(what)),
      WAIT,
      selector,
      text,
    );
  }

  /** The frame of the view, as soon as it has its page. */
  async view() {
    const end = Date.now() + WAIT.timeout;
    while (Date.now() < end) {
      for (const frame of this.page.frames()) {
        if (await frame.$("#legend").catch(() => null)) {
          return new View(this.page, frame);
        }
      }
      await new Promise((resolve) => setTimeout(resolve, POLL_MS));
    }
    throw new Error("no view");
  }
}

export class View {
  /**
   * @param {import("puppeteer-core").Page} page
   * @param {import("puppeteer-core").Frame} frame
   */
  constructor(page, frame) {
    this.page = page;
    this.frame = frame;
  }

  /**
   * Waits for a text in an element.
   * @param {string} id
   * @param {string} pattern
   */
  async says(id, pattern) {
    const ready = await this.frame.waitForFunction(
      (where, what) => {
        const found = document.getElementById(where);
        return found !== null && found.checkVisibility() && new RegExp(what).test(found.textContent ?? "") && found.textContent;
      },
      WAIT,
      id,
      pattern,
    );
    return /** @type {string} */ (await ready.jsonValue());
  }

  /** The picture, once it stays as it is. */
  async picture() {
    const read = () =>
      this.frame.evaluate(async () => {
        await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
        return /** @type {HTMLCanvasElement} */ (document.getElementById("canvas")).toDataURL();
      });
    let before = await read();
    for (let now = await read(); now !== before; now = await read()) {
      before = now;
    }
    return before;
  }

  /** How many colours of the scale the picture has. */
  colours() {
    return this.frame.evaluate(() => {
      const canvas = /** @type {HTMLCanvasElement} */ (document.getElementById("canvas"));
      const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
      const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
      const found = new Set();
      for (let at = 0; at < data.length; at += 4) {
        const [red, green, blue, alpha] = data.subarray(at, at + 4);
        if (alpha === 255 && Math.max(red, green, blue) - Math.min(red, green, blue) > 40) {
          found.add((red << 16) | (green << 8) | blue);
        }
      }
      return found.size;
    });
  }

  /** Moves the pointer over the canvas until it is above a movement, and leaves it there. */
  async pointAtMovement() {
    const canvas = await this.frame.$("#canvas");
    const box = await canvas?.boundingBox();
    if (!box) {
      throw new Error("no canvas");
    }
    for (let row = 0.15; row < 0.85; row += 0.03) {
      for (let column = 0.1; column < 0.9; column += 0.02) {
        await this.page.mouse.move(box.x + column * box.width, box.y + row * box.height);
        if (await this.frame.$eval("#tip", (tip) => tip.checkVisibility())) {
          return await this.says("tip", "line");
        }
      }
    }
    throw new Error("no movement under the pointer");
  }
}
