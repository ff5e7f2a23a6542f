// What a user does in VS Code.

const WAIT = { timeout: 30_000 };
const PALETTE = { timeout: 3_000 };
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
   * Goes to an open file.
   * @param {string} name
   */
  async showTab(name) {
    await this.page.locator(`.tab[data-resource-name="${name}"]`).click();
  }

  /**
   * Runs a command of the palette. The palette is opened more than once, because it lists what was there when it opened,
   * and a key that comes while the focus changes is lost.
   * @param {string} title
   */
  async run(title) {
    const end = Date.now() + WAIT.timeout;
    for (;;) {
      try {
        await this.page.keyboard.press("F1");
        await this.page.waitForSelector(".quick-input-widget:not([style*='display: none']) input", PALETTE);
        await this.page.keyboard.type(title);
        await this.page.waitForSelector(
          `.quick-input-list .monaco-list-row.focused[aria-label^="${title}"]`,
          PALETTE,
        );
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
        // Only the page's own world survives the way in which VS Code writes the page.
        if (await frame.evaluate(() => document.getElementById("legend") !== null).catch(() => false)) {
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

  /**
   * Where a place of the canvas is in the window.
   * @param {number} column 0: left, 1: right
   * @param {number} row 0: top, 1: bottom
   */
  async place(column, row) {
    const outer = await (await this.page.$("iframe.webview.ready"))?.boundingBox();
    if (!outer) {
      throw new Error("no view");
    }
    const inner = await this.frame.evaluate(() => {
      const { x, y, width, height } = /** @type {HTMLElement} */ (document.getElementById("canvas")).getBoundingClientRect();
      return { x, y, width, height };
    });
    return { x: outer.x + inner.x + column * inner.width, y: outer.y + inner.y + row * inner.height };
  }

  /** Clicks where nothing is drawn: the canvas has the focus. */
  async focus() {
    const { x, y } = await this.place(0.03, 0.03);
    await this.page.mouse.click(x, y);
  }

  /** @param {string} id of a button */
  async press(id) {
    await this.frame.evaluate((button) => document.getElementById(button)?.click(), id);
  }

  /** Moves the pointer over the canvas until it is above a movement, and leaves it there. */
  async pointAtMovement() {
    for (let row = 0.15; row < 0.85; row += 0.03) {
      for (let column = 0.1; column < 0.9; column += 0.02) {
        const { x, y } = await this.place(column, row);
        await this.page.mouse.move(x, y);
        if (await this.frame.evaluate(() => document.getElementById("tip")?.checkVisibility())) {
          return await this.says("tip", "line");
        }
      }
    }
    throw new Error("no movement under the pointer");
  }
}
