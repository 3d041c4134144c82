// Puts page.html, its styles and all scripts with their packages into one file:
//   node build.mjs OUTPUT
import { build } from "esbuild";
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const output = process.argv[2];
const path = (name) => fileURLToPath(new URL(`src/${name}`, import.meta.url));
const bundle = await build({
  entryPoints: [path("main.js")],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2020",
  charset: "ascii",
  legalComments: "inline",
  write: false,
});
const script = bundle.outputFiles[0].text.replaceAll("</script", "<\\/script");
// Functions as replacements: in a string, $ would have a meaning.
const page = readFileSync(path("page.html"), "utf8")
  .replace("/* page.css */", () => readFileSync(path("page.css"), "utf8"))
  .replace("/* main.js */", () => script);
writeFileSync(`${output}.part`, page);
renameSync(`${output}.part`, output);
