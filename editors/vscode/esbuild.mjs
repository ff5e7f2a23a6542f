// Builds dist/: the extension, the page of its view, and the licences of what is in them.
import { cp, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { build } from "esbuild";

const common = /** @type {const} */ ({ bundle: true, minify: true, metafile: true, logLevel: "warning" });

/**
 * The folders of packages whose files are in a bundle.
 * @param {import("esbuild").Metafile} metafile
 */
function packages(metafile) {
  const folders = Object.keys(metafile.inputs).map((file) => /^.*node_modules\/(@[^/]+\/)?[^/]+/.exec(file)?.[0]);
  return [...new Set(folders.filter((folder) => folder !== undefined))].sort();
}

/** @param {string} folder */
async function licence(folder) {
  const { name, version } = JSON.parse(await readFile(`${folder}/package.json`, "utf8"));
  const file = (await readdir(folder)).find((entry) => /^licen[cs]e/i.test(entry));
  if (file === undefined) {
    throw new Error(`${folder} has no licence`);
  }
  return `${name} ${version}\n\n${await readFile(`${folder}/${file}`, "utf8")}`;
}

await rm("dist", { recursive: true, force: true });
const extension = await build({
  ...common,
  entryPoints: ["src/extension.mjs"],
  outfile: "dist/extension.js",
  platform: "node",
  format: "cjs",
  target: "node18",
  external: ["vscode"],
});
await build({
  ...common,
  entryPoints: { view: "view/main.mjs", "view-style": "view/style.css" },
  outdir: "dist",
  platform: "browser",
  format: "iife",
  target: "chrome114",
});
const texts = await Promise.all(packages(extension.metafile).map(licence));
await writeFile("dist/THIRD-PARTY.txt", texts.join(`\n\n${"-".repeat(80)}\n\n`));
for (const name of ["LICENSE-APACHE", "LICENSE-MIT"]) {
  await cp(`../../${name}`, `dist/${name}`);
}
