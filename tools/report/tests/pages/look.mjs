// Looks at pages as people do, and prints what it sees as JSON: node look.mjs MODULES BROWSER PAGE...
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const [modules, executablePath, ...pages] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/`)('playwright-core');
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox'] });

// Opens a page, and keeps what it says and what it asks for.
async function open(file, options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const said = [];
  const asked = [];
  page.on('console', message => { if (message.type() === 'error') said.push(message.text()); });
  page.on('pageerror', error => said.push(String(error)));
  page.on('request', request => { if (!/^(file|data):/.test(request.url())) asked.push(request.url()); });
  await page.goto(pathToFileURL(file).href);
  return { context, page, said, asked };
}

const shown = page => page.locator('.frames').first().locator('figure:visible').count();
const wide = page => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
const ground = page => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

async function look(file) {
  const seen = { file };
  const large = await open(file, { viewport: { width: 1200, height: 800 } });
  const { page } = large;
  seen.frames = await page.locator('.frames').first().locator('figure').count();
  seen.sliders = await page.locator('.slide').count();
  if (seen.frames) {
    seen.shown = await shown(page);
    const bar = page.locator('.slide input').first();
    const caption = page.locator('.frames').first().locator('figure:visible figcaption');
    seen.last = await caption.textContent();
    await bar.evaluate(input => { input.value = 0; input.dispatchEvent(new Event('input')); });
    seen.first = await caption.textContent();
    seen.shown_after = await shown(page);
    const play = page.locator('.slide button').first();
    await play.click();
    await page.waitForFunction(from => document.querySelector('.frames figure:not([hidden]) figcaption').textContent !== from, seen.first);
    seen.playing = await play.textContent();
    await play.click();
  }
  const picture = page.locator('.zoom img:visible').first();
  if (await picture.count()) {
    seen.small = (await picture.boundingBox()).width;
    await picture.click();
    seen.enlarged = (await picture.boundingBox()).width;
    await picture.click();
    seen.small_again = (await picture.boundingBox()).width;
  }
  const link = page.locator('a.data').first();
  if (await link.count()) {
    const [file] = await Promise.all([page.waitForEvent('download'), link.click()]);
    const stream = await file.createReadStream();
    seen.saved = file.suggestedFilename();
    seen.csv = '';
    for await (const part of stream) seen.csv += part;
  }
  seen.light = await ground(page);
  await page.emulateMedia({ colorScheme: 'dark' });
  seen.dark = await ground(page);
  await page.emulateMedia({ media: 'print' });
  seen.printed_links = await page.locator('a.data:visible, nav:visible, .slide:visible').count();
  const small = await open(file, { viewport: { width: 400, height: 800 } });
  seen.too_wide = [await wide(page), await wide(small.page)];
  const plain = await open(file, { javaScriptEnabled: false });
  seen.without_script = seen.frames ? await shown(plain.page) : 0;
  const all = [large, small, plain];
  seen.said = all.flatMap(one => one.said);
  seen.asked = all.flatMap(one => one.asked);
  await Promise.all(all.map(one => one.context.close()));
  return seen;
}

const all = [];
for (const page of pages) all.push(await look(page));
console.log(JSON.stringify(all));
await browser.close();
