// The theme of the editor.

/** @returns {import("./draw.mjs").Look} */
export function look() {
  const style = getComputedStyle(document.body);
  const isLight = ["vscode-light", "vscode-high-contrast-light"].some((name) => document.body.classList.contains(name));
  return {
    theme: isLight ? "light" : "dark",
    foreground: style.color,
    faint: isLight ? "rgba(0, 0, 0, 0.13)" : "rgba(255, 255, 255, 0.14)",
    font: `12px ${style.fontFamily}`,
  };
}
