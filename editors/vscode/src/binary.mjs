// Where the command `joulepath` is.
import { accessSync, constants, statSync } from "node:fs";
import { delimiter, join } from "node:path";

/**
 * @typedef {object} Place
 * @property {string} setting the setting `joulepath.path`
 * @property {string} extension the folder of the extension
 * @property {string} home the folder of the user
 * @property {string} path the environment variable PATH
 * @property {string} platform as `process.platform`
 * @property {string} arch as `process.arch`
 */

/** @param {string} file */
export function isExecutable(file) {
  try {
    accessSync(file, constants.X_OK);
    return statSync(file).isFile();
  } catch {
    return false;
  }
}

/**
 * Where the command may be, the first place first.
 * @param {Place} place
 */
export function candidates({ setting, extension, home, path, platform, arch }) {
  const folders = path.split(delimiter).filter((folder) => folder !== "");
  if (setting !== "") {
    return /[\\/]/.test(setting) ? [setting.replace(/^~(?=[\\/])/, home)] : folders.map((folder) => join(folder, setting));
  }
  const name = platform === "win32" ? "joulepath.exe" : "joulepath";
  return [
    join(extension, "bin", `${platform}-${arch}`, name),
    ...folders.map((folder) => join(folder, name)),
    join(home, ".cargo", "bin", name),
  ];
}

/**
 * The command, if it is there.
 * @param {Place} place
 */
export function findBinary(place) {
  return candidates(place).find(isExecutable);
}
