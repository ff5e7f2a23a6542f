// The view of the path beside the text.
import { randomBytes } from "node:crypto";
import { Range, Selection, TextEditorRevealType, ThemeColor, Uri, ViewColumn, commands, window } from "vscode";
import { page } from "./html.mjs";

/** @typedef {{ type: "busy" } | { type: "error", text: string } | ({ type: "path" } & import("./simulate.mjs").Traced)} State */

export class Panel {
  /** @type {import("vscode").WebviewPanel | undefined} */
  #panel;
  /** @type {State} */
  #state = { type: "busy" };
  #hovered = window.createTextEditorDecorationType({
    isWholeLine: true,
    backgroundColor: new ThemeColor("editor.rangeHighlightBackground"),
  });

  /**
   * @param {import("vscode").Uri} extension its folder
   * @param {() => void} again runs the simulation again
   */
  constructor(extension, again) {
    this.extension = extension;
    this.again = again;
  }

  /** @param {State} state */
  show(state) {
    this.#state = state;
    if (this.#panel === undefined) {
      this.#open();
    } else {
      this.#panel.reveal(undefined, true);
      this.#send(state);
    }
  }

  /** @param {import("vscode").TextEditor | undefined} editor */
  follow(editor) {
    if (editor !== undefined && editor.document.languageId === "rapid") {
      const { document, selection } = editor;
      this.#send({ type: "cursor", file: document.uri.fsPath, line: selection.active.line + 1 });
    }
  }

  dispose() {
    this.#panel?.dispose();
    this.#hovered.dispose();
  }

  #open() {
    const dist = Uri.joinPath(this.extension, "dist");
    const panel = window.createWebviewPanel(
      "joulepath.path",
      "Path of the tool",
      { viewColumn: ViewColumn.Beside, preserveFocus: true },
      { enableScripts: true, localResourceRoots: [dist] },
    );
    const { webview } = panel;
    const address = (/** @type {string} */ file) => webview.asWebviewUri(Uri.joinPath(dist, file)).toString();
    panel.onDidDispose(() => {
      this.#panel = undefined;
      this.#mark(undefined);
    });
    webview.onDidReceiveMessage((message) => this.#receive(message));
    webview.html = page({
      script: address("view.js"),
      style: address("view-style.css"),
      source: webview.cspSource,
      nonce: randomBytes(16).toString("hex"),
    });
    this.#panel = panel;
  }

  /** @param {State | { type: "cursor", file: string, line: number }} message */
  #send(message) {
    void this.#panel?.webview.postMessage(message);
  }

  /** @param {{ type: string, segment?: number }} message of the page */
  #receive({ type, segment }) {
    if (type === "ready") {
      this.#send(this.#state);
      this.follow(window.activeTextEditor);
    } else if (type === "again") {
      this.again();
    } else if (type === "robot") {
      void commands.executeCommand("joulepath.chooseRobot").then(() => this.again());
    } else if (type === "hover") {
      this.#mark(this.#segment(segment));
    } else if (type === "reveal") {
      void this.#reveal(this.#segment(segment));
    }
  }

  /** @param {number | undefined} index */
  #segment(index) {
    return this.#state.type === "path" && index !== undefined ? this.#state.path.segments[index] : undefined;
  }

  /**
   * Marks the line of a segment in the editors that show its file.
   * @param {import("./trajectory.mjs").Segment | undefined} segment
   */
  #mark(segment) {
    for (const editor of window.visibleTextEditors) {
      if (segment === undefined || editor.document.uri.fsPath !== segment.file) {
        editor.setDecorations(this.#hovered, []);
      } else {
        const range = new Range(segment.line - 1, 0, segment.line - 1, 0);
        editor.setDecorations(this.#hovered, [range]);
        editor.revealRange(range, TextEditorRevealType.InCenterIfOutsideViewport);
      }
    }
  }

  /** @param {import("./trajectory.mjs").Segment | undefined} segment */
  async #reveal(segment) {
    if (segment !== undefined) {
      const shown = window.visibleTextEditors.find((editor) => editor.document.uri.fsPath === segment.file);
      await window.showTextDocument(Uri.file(segment.file), {
        viewColumn: shown?.viewColumn ?? ViewColumn.One,
        preserveFocus: true,
        selection: new Selection(segment.line - 1, 0, segment.line - 1, 0),
      });
    }
  }
}
