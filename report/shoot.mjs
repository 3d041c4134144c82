// Pictures of parts of a report, for documents:
//   node shoot.mjs BROWSER PAGE FOLDER STEP... [--packages FOLDER]
// STEP: NAME=SELECTOR writes FOLDER/NAME.png of that part, NAME= what fits on a screen; !EXPRESSION is evaluated in the page before.
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const words = process.argv.slice(2);
const at = words.indexOf("--packages");
const [, packages] = at < 0 ? [null, "."] : words.splice(at, 2);
const [browserPath, report, folder, ...steps] = words;
const { default: puppeteer } = await import(pathToFileURL(createRequire(resolve(packages, "package.json")).resolve("puppeteer-core")));

const browser = await puppeteer.launch({ executablePath: browserPath, headless: true,
  args: ["--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const settled = () => new Promise((done) => setTimeout(done, 1500));
try {
  const page = await browser.newPage();
  await page.setViewport({ width: 1200, height: 1500 });
  await page.goto(pathToFileURL(resolve(report)).href);
  await page.waitForSelector("body[data-ready=yes]", { timeout: 120000 });
  await page.addStyleTag({ content: ".vega-actions-wrapper, .vega-embed summary { display: none !important; }" });
  for (const step of steps) {
    if (step.startsWith("!")) {
      await page.evaluate(step.slice(1));
      continue;
    }
    await settled();
    const [name, ...selector] = step.split("=");
    const path = join(folder, `${name}.png`);
    if (selector.join("=") === "") await page.screenshot({ path });
    else await (await page.$(selector.join("="))).screenshot({ path });
  }
} finally {
  await browser.close();
}
