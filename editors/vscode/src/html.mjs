// The page of the view.

/**
 * @param {{ script: string, style: string, source: string, nonce: string }} of addresses of the files, the source
 *   that may give styles, and a word that nobody can guess
 */
export function page({ script, style, source, nonce }) {
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src ${source}; script-src 'nonce-${nonce}'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="stylesheet" href="${style}">
<title>Path of the tool</title>
</head>
<body>
<header>
  <h1 id="title">The simulation runs …</h1>
  <button id="again" type="button">Run again</button>
  <button id="reset" type="button">Reset the view</button>
</header>
<section id="failure" hidden>
  <pre id="message" role="alert"></pre>
  <button id="robot" type="button">Choose the robot</button>
</section>
<main id="drawing" hidden>
  <canvas id="canvas" tabindex="0" role="application" aria-label="Path of the tool in 3-D" aria-describedby="keys"></canvas>
  <div id="tip" hidden></div>
  <figure id="legend">
    <figcaption>Electrical power</figcaption>
    <div id="scale"></div>
    <div id="ends"><span id="least"></span><span id="middle"></span><span id="most"></span></div>
    <div id="mesh"></div>
  </figure>
  <p id="keys">Drag or arrow keys: turn. With Shift: move. Wheel or + and −: zoom. Page Up and Page Down: the movement before and after. Enter: its line.</p>
</main>
<p id="current" aria-live="polite"></p>
<details id="remarks" hidden><summary></summary><pre></pre></details>
<script nonce="${nonce}" src="${script}"></script>
</body>
</html>
`;
}
