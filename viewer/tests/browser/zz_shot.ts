import { open, settle } from "./browser.ts";
// shot FILE OUT WIDTH HEIGHT SCHEME [selector]
const [file, out, width, height, scheme, selector] = process.argv.slice(2);
const { page, close, complaints } = await open(file!, (scheme ?? "light") as "light");
await page.setViewportSize({ width: Number(width ?? 1280), height: Number(height ?? 900) });
await settle(page);
if (selector) await page.locator(selector).first().screenshot({ path: out! });
else await page.screenshot({ path: out! });
console.log(complaints);
await close();
