// Which files are the program of an open file.
import { existsSync, statSync } from "node:fs";
import { dirname, join } from "node:path";

/**
 * What may be the program of a file or folder: the backup around a file, or else the files around it, or else the
 * file alone.
 * @param {string} path
 * @param {string} root the folder that the editor has open: nothing above it counts
 */
export function programsOf(path, root) {
  if (statSync(path).isDirectory()) {
    return [path];
  }
  for (let folder = dirname(path); folder.startsWith(root); folder = dirname(folder)) {
    if (existsSync(join(folder, "BACKINFO"))) {
      return [folder];
    }
    if (folder === dirname(folder)) {
      break;
    }
  }
  return [dirname(path), path];
}
