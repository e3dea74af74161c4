// The section that draws with WebGL 2: as the run drew, on two implementations of it.
import assert from "node:assert/strict";
import { changeFrames, kMesa, kOwn, openLive, press, readTable } from "./live_support.mjs";
import { pageOf, pick, testPage } from "./support.mjs";

// On the second every filter is drawn once; the other kinds of map are those of few filters there.
for (const [title, args, mostScenes] of [["OnTheRunsOwnRasteriser", kMesa, 9], ["OnAnotherImplementation", kOwn, 1]])
  for (const [run, count, absent] of [["live", 29, { textureGather: 2 }], ["lamps", 4, {}], ["fits", 18, { "geometry shaders": 2 }],
    ["hashed", 3, {}], ["dither", 3, {}]])
    testPage(`EveryFilterDrawsAsTheRunDid_${title}: ${run}`, () => openLive(pageOf(run), { args }), async ({ page }) => {
      const requests = [], scenes = await page.locator(".live select").first().locator("option").allTextContents();
      page.on("request", (request) => requests.push(request.url()));
      for (const scene of run === "live" ? scenes.slice(0, mostScenes) : scenes) {
        await pick(page, "Scene", { label: scene }, ".live");
        await press(page, "Check against the run");
        const rows = await readTable(page), left = { ...absent };
        assert.equal(rows.length, count, scene);
        for (const [filter, rmse] of rows) {
          const lacks = Object.keys(left).find((name) => rmse.includes(name));
          if (lacks) --left[lacks];
          else assert.match(rmse, /^[\d.e-]+$/, `${filter} on ${scene}`);
        }
        assert.ok(Object.values(left).every((rest) => rest === 0), JSON.stringify(left));
      }
      assert.deepEqual(requests.filter((url) => !url.startsWith("file://")), []);
    });

// Checks a run whose shaders `edit` has changed; `act` gets the result of each filter.
const testShaders = (name, edit, act) => testPage(name, () => openLive(changeFrames("untrue", name, edit)), async ({ page }) => {
  await press(page, "Check against the run");
  act(Object.fromEntries((await readTable(page)).map(([filter, text]) => [filter, text])));
}, /GL_INVALID|shader/);
testShaders("AWrongSignInAShader_IsSeen", ({ programs }) => {
  for (const each of programs.filter(({ label }) => label === "vsm lookup")) each.fragment = each.fragment.replace("moments.y -", "moments.y +");
}, (rows) => {
  assert.match(rows.vsm, /^✗/);
  assert.doesNotMatch(rows.pcf2x2, /✗/);
});
testShaders("AShaderThatTheBrowserRefuses_IsSaidInItsRow", ({ programs }) => {
  for (const each of programs.filter(({ label }) => label === "pcf2x2 lookup")) each.fragment = each.fragment.replace("void main()", "void nothing()");
  for (const each of programs.filter(({ label }) => label === "vsm encode")) Object.assign(each, { vertex: undefined, refused: "WebGL 2 cannot have this" });
}, (rows) => {
  assert.match(rows.pcf2x2, /refuses the shader of pcf2x2 lookup/);
  assert.match(rows.vsm, /WebGL 2 cannot have this/);
  assert.match(rows.none, /^[\d.e-]+$/);
});
