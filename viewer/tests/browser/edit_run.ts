// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// npm run test:edits            a simulated recording edited in the page of `kinemark serve`
// npm run test:edits -- FILE... the same of C3D files with three markers that are whole, of which copies are edited
// KINEMARK_PROGRAM names the program, KINEMARK_SCREENSHOTS a folder for pictures.
import type { MarkersPage } from "../../src/page_types.ts";
import assert from "node:assert/strict";
import { once } from "node:events";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import type { Page } from "playwright-core";
import { problemsOf } from "../../schema/problems.ts";
import { hostile } from "../simulated.ts";
import { ink, openAddress, settle, type Opened } from "./browser.ts";
import { clipped, violations } from "./looks.ts";
import { kinemark, serve, type Served } from "./serving.ts";

interface Tried extends Opened {
  served: Served;
  recording: string;
  journal: string;
  /** Names of three markers that are there in all frames. */
  names: [string, string, string];
  first: number;
  /** The body model beside the recording; null: there is none. */
  model: string | null;
  /** Answers of the server that the schema knows, by type, and what is wrong with them. */
  answers: { counts: Record<string, number>; problems: string[] };
}

/** Hold each answer of the server against the schema. */
function judgeAnswers(page: Page): Tried["answers"] {
  const answers: Tried["answers"] = { counts: {}, problems: [] };
  const types: Record<string, string> = { edits: "EditingState", data: "MarkersPage", angles: "AnglesState" };
  page.on("response", async (response) => {
    const what = /\/api\/trial\/\d+\/(\w+)$/.exec(response.url())?.[1] ?? "";
    const type = response.ok() ? types[what] : what in types ? "Refusal" : undefined;
    const body: unknown = type === undefined ? undefined : await response.json().catch(() => undefined);
    if (type === undefined || body === undefined) return;
    answers.counts[type] = (answers.counts[type] ?? 0) + 1;
    answers.problems.push(...problemsOf(body, type));
  });
  return answers;
}

/** Wait until no solution is under way, and give what the section says. */
const solved = async (page: Page, words: RegExp): Promise<string> => {
  await page.waitForFunction((w) => new RegExp(w, "u").test(document.getElementById("solved")?.textContent ?? ""), words.source);
  await settle(page);
  return (await page.locator("#solved").textContent()) ?? "";
};

const said = async (page: Page, words: RegExp): Promise<string> => {
  await page.waitForFunction((w) => new RegExp(w, "u").test(document.getElementById("edit-said")?.textContent ?? "") && document.getElementById("edit")!.getAttribute("aria-busy") !== "true", words.source);
  await settle(page);
  return (await page.locator("#edit-said").textContent()) ?? "";
};
const press = async (page: Page, name: string | RegExp): Promise<void> => page.locator("#edit").getByRole("button", { name, exact: typeof name === "string" }).click();
const entries = (page: Page): Promise<string[]> => page.locator("#edit-list .words").allTextContents();
const operations = (t: Tried): { do: string; marker?: string }[] =>
  existsSync(t.journal) ? readFileSync(t.journal, "utf8").trim().split("\n").slice(1).map((l) => JSON.parse(l) as { do: string }) : [];
const choose = async (t: Tried, marker: string, first: number | null, last: number | null): Promise<void> => {
  await t.page.selectOption("#edit-markers", marker);
  await t.page.fill("#edit-from", first === null ? "" : String(first));
  await t.page.fill("#edit-to", last === null ? "" : String(last));
  await t.page.locator("#edit-to").blur();
  await settle(t.page);
};
/** What the list of the program says of the journal. */
const listed = (t: Tried): { digest: string; edits: { words: string; in_force?: boolean }[] } =>
  JSON.parse(kinemark("edit", t.recording, "--list", "--json")) as ReturnType<typeof listed>;

const checks: Record<string, (t: Tried) => Promise<void>> = {
  "the page of a recording has a bar for edits, with names for everything": async ({ page }) => {
    assert.equal(await page.locator("#edit").count(), 1);
    assert.equal(await page.locator("#edit-list li").count(), 0);
    for (const id of ["edit-markers", "edit-from", "edit-to", "edit-method", "edit-other", "edit-name", "edit-region", "edit-label", "edit-side", "edit-event", "edit-keys"])
      assert.ok((await page.locator(`#${id}`).evaluate((e) => (e as HTMLInputElement).labels!.length)) > 0, id);
    assert.equal(await page.getByRole("button", { name: "Undo" }).isDisabled(), true);
  },
  "relabel is saved, shown and taken back": async (t) => {
    const { page, names } = t;
    await choose(t, names[0], null, null);
    await page.fill("#edit-name", hostile);
    await press(page, "Relabel");
    await said(page, /Made and saved: relabel/);
    assert.equal(operations(t).length, 1);
    assert.deepEqual((await page.locator("#marker-name option").allTextContents()).filter((n) => n === hostile || n === names[0]), [hostile]);
    assert.equal(await page.locator("#page img").count(), 0, "a name is text");
    assert.match((await page.locator("#edit-changed").textContent()) ?? "", /came/);
    await page.keyboard.press("Control+z");
    await said(page, /Made and saved: undo/);
    assert.ok((await page.locator("#marker-name option").allTextContents()).includes(names[0]));
    assert.equal(await page.locator("#edit-list .undone").count(), 1);
  },
  "swap from a moment on changes both curves, and shows what was recorded": async (t) => {
    const { page, names, first } = t;
    await choose(t, names[1], first + 20, null);
    await page.selectOption("#edit-other", names[2]);
    const before = await ink(page, "#plot-x canvas");
    await press(page, "Swap");
    await said(page, /Made and saved: swap/);
    assert.notEqual((await ink(page, "#plot-x canvas")).hash, before.hash);
    assert.match((await page.locator("#marker .keys").textContent()) ?? "", /as recorded, before the edits/);
    assert.match((await page.locator("#edit-changed details").first().textContent()) ?? "", /samples moved, [\d.,]+ mm at most/);
    assert.equal(await page.locator("#marker-name").evaluate((s) => (s as HTMLSelectElement).value), names[1], "the marker stays chosen");
  },
  "a span is chosen on the curve with Shift, cut, filled and unfilled": async (t) => {
    const { page, names, first } = t;
    await choose(t, names[1], null, null);
    await page.locator("#plot-y").scrollIntoViewIfNeeded();
    const range = await page.locator(".bar .range").textContent();
    const box = (await page.locator("#plot-y .u-over").boundingBox())!;
    await page.keyboard.down("Shift");
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.4 * box.width, box.y + 60, { steps: 4 });
    await page.mouse.up();
    await page.keyboard.up("Shift");
    await settle(page);
    assert.equal(await page.locator(".bar .range").textContent(), range, "nothing is zoomed");
    const [from, to] = [Number(await page.inputValue("#edit-from")), Number(await page.inputValue("#edit-to"))];
    assert.ok(from > first && to > from, `${from} to ${to}`);
    await press(page, "Cut");
    await said(page, /Made and saved: cut/);
    await page.selectOption("#edit-method", "linear");
    await press(page, "Fill");
    await said(page, /Made and saved: fill/);
    assert.match((await page.locator("#marker .keys").textContent()) ?? "", /interpolated/);
    assert.match((await page.locator("#edit-changed details").first().textContent()) ?? "", new RegExp(`${(to - from + 1).toLocaleString("en-US")} came`));
    await press(page, "Unfill");
    await said(page, /Made and saved: unfill/);
    assert.deepEqual(operations(t).slice(-3).map((o) => o.do), ["cut", "fill", "unfill"]);
  },
  "letters and brackets do the same as buttons": async (t) => {
    const { page, names } = t;
    await choose(t, names[2], null, null);
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("End");
    await settle(page);
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("[");
    await settle(page);
    const from = Number(await page.inputValue("#edit-from"));
    assert.ok(from > 0);
    await page.keyboard.press("c");
    await said(page, /Made and saved: cut/);
    assert.equal(operations(t).at(-1)!.do, "cut");
    await page.keyboard.press("Escape");
    assert.equal(await page.inputValue("#edit-from"), "");
    const made = operations(t).length;
    await page.locator("#edit-name").focus();
    await page.keyboard.press("c");
    assert.equal(await page.inputValue("#edit-name"), `${hostile}c`, "letters are text where somebody types");
    assert.equal(operations(t).length, made);
    await page.fill("#edit-name", "");
    await page.locator("#edit-keys").uncheck();
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("c");
    await settle(page);
    assert.equal(operations(t).length, made, "and nothing when they are switched off");
    await page.locator("#edit-keys").check();
  },
  "events are marked, moved and deleted, regions named, frames cropped": async (t) => {
    const { page, first } = t;
    const events = await page.locator("#edit-event option").count();
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("Home");
    await settle(page);
    await page.fill("#edit-label", "Turn");
    await page.selectOption("#edit-side", "Left");
    await press(page, "Mark");
    await said(page, /Made and saved: mark/);
    assert.equal(await page.locator("#edit-event option").count(), events + 1);
    const at = (await page.locator("#edit-event option").allTextContents()).findIndex((o) => o.startsWith("Turn, Left"));
    await page.selectOption("#edit-event", { index: at });
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("ArrowRight");
    await settle(page);
    await press(page, "Move");
    await said(page, /Made and saved: move/);
    await page.selectOption("#edit-event", { index: (await page.locator("#edit-event option").allTextContents()).findIndex((o) => o.startsWith("Turn, Left")) });
    await press(page, "Delete");
    await said(page, /Made and saved: deletion|Made and saved: delete/);
    assert.equal(await page.locator("#edit-event option").count(), events);
    await page.fill("#edit-from", String(first + 5));
    await page.fill("#edit-to", String(first + 30));
    await page.fill("#edit-region", "gait");
    await press(page, "Name region");
    await said(page, /Made and saved: region/);
    assert.match((await page.locator("#edit-changed").textContent()) ?? "", /gait: frames/);
    await page.fill("#edit-from", String(first + 2));
    await page.fill("#edit-to", "");
    await press(page, "Crop");
    await said(page, /Made and saved: crop/);
    assert.match((await page.locator(".clock").textContent()) ?? "", /frame/);
  },
  "a refusal is a sentence, and nothing is written": async (t) => {
    const { page, names } = t;
    const made = operations(t).length;
    await choose(t, names[0], 1_000_000, 1_000_001);
    await press(page, "Cut");
    const refused = await said(page, /frame/);
    assert.match(refused, /1000000|1,000,000/);
    assert.equal(await page.locator("#edit-said").getAttribute("role"), "alert");
    await press(page, "Everywhere");
    await press(page, "Crop");
    assert.match(await said(page, /frames/), /Choose the frames that shall stay/);
    assert.equal(operations(t).length, made);
  },
  "the list goes back several at once, and redo brings all of it again": async (t) => {
    const { page } = t;
    const before = listed(t).digest;
    const done = (await entries(page)).length;
    await page.locator("#edit-list").getByRole("button", { name: "Undo to here" }).last().click();
    await said(page, /Made and saved: undo/);
    assert.equal(await page.locator("#edit-list .undone").count(), done);
    assert.equal(await page.locator("#marker .keys .recorded").count(), 0, "as recorded: there is nothing to compare");
    for (let i = 0; i < 30 && !(await page.locator("#edit").getByRole("button", { name: /^Redo/ }).isDisabled()); ++i) {
      await press(page, /^Redo/);
      await said(page, /Made and saved: redo/);
    }
    assert.equal(listed(t).digest, before);
    await page.reload();
    await page.waitForFunction(() => document.documentElement.dataset["ready"] !== undefined);
    assert.equal(await page.locator("#edit-list li").count(), done);
  },
  "what another page or program does is seen": async (t) => {
    const { page, names } = t;
    const other = await page.context().newPage();
    await other.goto(page.url().split("#")[0]!);
    await other.waitForFunction(() => document.documentElement.dataset["ready"] !== undefined);
    await choose(t, names[2], t.first + 30, t.first + 33);
    await press(page, "Cut");
    await said(page, /Made and saved: cut/);
    // What the other page does on top of what it has not seen is not made, whichever of both ways it learns of it.
    await other.waitForFunction(() => /Somebody else has edited/.test(document.getElementById("edit-said")?.textContent ?? ""));
    assert.equal(await other.locator("#edit-list li").count(), await page.locator("#edit-list li").count());
    kinemark("edit", t.recording, "--undo", "1");
    await page.bringToFront();
    await said(page, /Somebody else has edited/);
    await other.close();
  },
  "the list leads to the recording, and what is not there is a sentence": async ({ page, served, recording }) => {
    const list = await page.context().newPage();
    const complaints: string[] = [];
    list.on("console", (m) => m.type() === "error" && !/status of 404/.test(m.text()) && complaints.push(m.text()));
    list.on("pageerror", (e) => complaints.push(String(e)));
    await list.goto(served.address);
    await list.waitForFunction(() => document.querySelectorAll("#trials tbody tr").length === 1 && !/being read/.test(document.querySelector("#trials .lead")!.textContent!));
    assert.equal(await list.title(), "Trials - kinemark");
    const data = await list.evaluate(() => JSON.parse(document.getElementById("kinemark-data")!.textContent) as unknown);
    assert.deepEqual(problemsOf(data, "TrialsPage"), []);
    assert.deepEqual(await violations(list), []);
    await list.locator("#trials a").click();
    await list.waitForFunction(() => document.documentElement.dataset["ready"] === "yes" && document.getElementById("edit") !== null);
    assert.equal(new URL(list.url()).pathname, new URL(page.url()).pathname);
    await list.goto(new URL("99", list.url()).href);
    assert.match((await list.locator("main").textContent()) ?? "", /There is no trial of that number/);
    await list.getByRole("link", { name: "All trials" }).click();
    assert.match((await list.locator("#trials th a").textContent()) ?? "", new RegExp(basename(recording).replace(".", "\\.")));
    assert.deepEqual(complaints, []);
    await list.close();
  },
  "a page on another port reads nothing and writes nothing": async ({ page, served, journal }) => {
    const got: string[] = [];
    const other = createServer((request, response) => {
      got.push(JSON.stringify(request.headers));
      response.setHeader("Content-Type", "text/html").end("<p>A page of another program</p>");
    }).listen(0, "127.0.0.1");
    await once(other, "listening");
    const before = readFileSync(journal);
    const theirs = await page.context().newPage();
    await theirs.goto(`http://127.0.0.1:${(other.address() as AddressInfo).port}/`);
    const answers = await theirs.evaluate(async (origin) => {
      const said: string[] = [];
      const edit = '{"expected":0,"edit":{"do":"crop","first":1}}';
      for (const path of ["/", "/trial/1", "/api/trials", "/api/trial/1/data", "/api/trial/1/edits"])
        for (const method of ["GET", "POST"]) {
          const body = method === "POST" ? { body: edit } : {};
          said.push(await fetch(origin + path, { method, credentials: "include", ...body }).then((answer) => answer.text(), () => "nothing"));
        }
      said.push(
        await new Promise((done) => {
          const socket = new WebSocket(`${origin.replace("http", "ws")}/live/socket`);
          socket.onopen = () => done("open");
          socket.onerror = () => done("nothing");
        }),
      );
      return said;
    }, served.origin);
    assert.deepEqual([...new Set(answers)], ["nothing"]);
    const session = new URL(page.url()).pathname.split("/")[1]!;
    assert.match(session, /^[0-9a-f]{32}$/);
    assert.ok(got.length > 0 && got.every((headers) => !/cookie/i.test(headers) && !headers.includes(session)), got.join());
    assert.deepEqual(await page.context().cookies(), []);
    assert.deepEqual(readFileSync(journal), before);
    await theirs.close();
    other.close();
  },
  "without a body model the page says so": async ({ page, served, model }) => {
    if (model === null) return;
    renameSync(model, `${model}.away`);
    await solved(page, /No body model is known for/);
    assert.equal(await page.locator("#solved").getByRole("button", { name: "Solve" }).isDisabled(), true);
    const refused = await page.evaluate(async () => (await fetch("../api/trial/1/angles", { method: "POST", headers: { "Content-Type": "application/json" }, body: '{"do":"solve"}' })).status);
    assert.equal(refused, 422);
    assert.equal((await fetch(`${served.origin}/api/trial/1/angles`)).status, 401, "strangers are told nothing");
    renameSync(`${model}.away`, model);
    await solved(page, /Not solved yet; the model is subject.osim/);
  },
  "angles are solved with the edits, lie over those as recorded, and are those of the command": async (t) => {
    const { page, recording, model, names, first } = t;
    if (model === null) return;
    await choose(t, names[1], first + 30, first + 50);
    await page.selectOption("#edit-other", names[2]);
    await press(page, "Swap");
    await said(page, /Made and saved: swap/);
    await page.locator(".space-canvas").focus();
    await page.keyboard.press("a");
    const words = await solved(page, /Solved with \d+ edits? and subject.osim.*from the solution as recorded/);
    assert.match(words, /coordinates? differs? from the solution as recorded/);
    assert.match(words, /at most [\d.]+ (deg|mm) (more|less)/);
    assert.match(words, /(none|\d+) by more than two standard deviations/);
    await page.waitForFunction(() => document.querySelectorAll(".solved-curves .u-over").length >= 2);
    assert.match((await page.locator(".solved-curves").textContent()) ?? "", /Dashed over it: the solution as recorded, angles [\d.]+ deg apart RMS/);
    assert.notEqual((await ink(page, ".solved-curves canvas")).hash, 0);
    const told = await page.evaluate(async () => (await (await fetch("../api/trial/1/angles")).json()) as { solutions: { now: { set: string; digest: string } } });
    const out = join(recording, "..", "command.mot");
    kinemark("ik", "--model", model, "--markers", recording, "--edits", "beside", "--output", out, "--force", "--quiet");
    const report = JSON.parse(readFileSync(out.replace(".mot", "_report.json"), "utf8")) as { kinemark_set: string };
    assert.equal(told.solutions.now.set, report.kinemark_set, "the same bits");
    assert.equal(told.solutions.now.digest, listed(t).digest);
  },
  "an edit makes the angles old, and the next ones lie over those from before": async (t) => {
    const { page, model, names, first } = t;
    if (model === null) return;
    await choose(t, names[0], first + 60, first + 70);
    await press(page, "Cut");
    await said(page, /Made and saved: cut/);
    await solved(page, /The recording was edited since: solve it again/);
    assert.ok((await page.locator(".solved-curves .u-over").count()) >= 2, "what was solved stays");
    const before = (await page.locator("#solved-facts").textContent()) ?? "";
    await page.locator("#solved").getByRole("button", { name: "Solve" }).click();
    await page.waitForFunction((b) => (document.getElementById("solved-facts")?.textContent ?? b) !== b && document.getElementById("solved-facts")!.textContent!.includes("Solved with"), before);
    await solved(page, /from the solution/);
    await page.selectOption("#solved-over", "before");
    await solved(page, /from the solution with \d+ edits?, as solved before/);
    const report = await page.context().newPage();
    await report.goto(new URL((await page.locator("#solved a").getAttribute("href"))!, page.url()).href);
    await report.waitForFunction(() => document.documentElement.dataset["ready"] === "yes");
    assert.equal(await report.locator("#angles").count(), 1, "its whole report is a page of its own");
    await report.close();
    await page.locator("#solved-changes button").first().click();
    await settle(page);
    assert.equal(await page.evaluate(() => location.hash), "#compare");
  },
  "light, dark and 390 px: nothing clipped, axe has nothing against it": async ({ page, recording }) => {
    const folder = process.env["KINEMARK_SCREENSHOTS"];
    const wrong: string[] = [];
    for (const [kind, width, colorScheme] of [["light", 1280, "light"], ["dark", 1280, "dark"], ["phone", 390, "light"]] as const) {
      await page.setViewportSize({ width, height: 900 });
      await page.emulateMedia({ colorScheme });
      await settle(page);
      if (folder !== undefined) {
        const name = recording.split("/").at(-1)!.replace(".c3d", "");
        await page.screenshot({ path: join(folder, `edit_${name}_${kind}.png`), fullPage: true });
        await page.locator("#edit").screenshot({ path: join(folder, `edit_${name}_${kind}_bar.png`) });
        await page.locator("#solved").screenshot({ path: join(folder, `edit_${name}_${kind}_angles.png`) });
        if ((await page.locator(".solved-curves section").count()) > 0) await page.locator(".solved-curves").screenshot({ path: join(folder, `edit_${name}_${kind}_curves.png`) });
      }
      wrong.push(...(await clipped(page)).map((c) => `${kind}: ${c}`), ...(await violations(page)).map((v) => `${kind}: ${v}`));
    }
    await page.setViewportSize({ width: 1280, height: 900 });
    await page.emulateMedia({ colorScheme: "light" });
    assert.deepEqual(wrong, []);
  },
  "what the server answered follows the schema": async ({ answers, model }) => {
    assert.deepEqual(answers.problems.slice(0, 5), []);
    for (const type of ["EditingState", "MarkersPage", "Refusal", ...(model === null ? [] : ["AnglesState"])]) assert.ok((answers.counts[type] ?? 0) > 0, `no answer is of the type ${type}`);
  },
  "nothing but this server was asked, and nothing complained": async ({ complaints }) => {
    assert.deepEqual(complaints.filter((c) => !c.includes("status of 422") && !c.includes("status of 409")), []);
  },
  "a server that is gone is a sentence": async ({ page, served, names, recording }) => {
    served.process.kill("SIGKILL");
    await page.selectOption("#edit-markers", names[1]);
    await press(page, "Cut");
    assert.match(await said(page, /does not answer/), /journal/);
    assert.ok(existsSync(recording));
  },
};

async function tryOn(recording: string, given: string): Promise<number> {
  copyFileSync(given, recording);
  const original = readFileSync(recording);
  const lies = given.replace("markers.c3d", "model.osim");
  const model = lies !== given && existsSync(lies) ? join(recording, "..", "subject.osim") : null;
  if (model !== null) copyFileSync(lies, model);
  const served = await serve(recording);
  const opened = await openAddress(served.address, (asked) => asked.startsWith(`${served.origin}/`), "light", true, "trial/1");
  const answers = judgeAnswers(opened.page);
  // What is cut and swapped has to be there: whole markers, as the page itself tells.
  const { summary } = await opened.page.evaluate(() => JSON.parse(document.getElementById("kinemark-data")!.textContent) as MarkersPage);
  const whole = summary.markers.filter((m) => m.labelled && m.states.measured === summary.frames).map((m) => m.name);
  assert.ok(whole.length >= 3, "the recording has no three whole markers");
  const names = whole.slice(0, 3) as [string, string, string];
  const t: Tried = { ...opened, served, recording, journal: recording.replace(".c3d", "_edits.jsonl"), names, first: summary.first_frame, model, answers };
  let failed = 0;
  const all: typeof checks = {
    ...checks,
    "the recording's bytes are what they were": async () => assert.ok(readFileSync(recording).equals(original)),
  };
  for (const [name, check] of Object.entries(all)) {
    try {
      await check(t);
      console.log(`ok      ${name}`);
    } catch (error) {
      ++failed;
      console.log(`FAILED  ${name}\n${error instanceof Error ? error.message : String(error)}`);
    }
  }
  await opened.close();
  served.process.kill("SIGKILL");
  return failed;
}

const folder = mkdtempSync(join(tmpdir(), "kinemark-edits-"));
let failed = 0;
try {
  let files = process.argv.slice(2);
  if (files.length === 0) {
    kinemark("simulate", "subject", "-o", join(folder, "in"), "--duration", "1", "--quiet");
    files = [join(folder, "in", "markers.c3d")];
  }
  for (const [i, file] of files.entries()) {
    mkdirSync(join(folder, String(i)));
    failed += await tryOn(join(folder, String(i), file.split("/").at(-1)!), file);
  }
} finally {
  rmSync(folder, { recursive: true });
}
process.exitCode = failed === 0 ? 0 : 1;
