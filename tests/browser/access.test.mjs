// Every page is silent, accessible and no wider than the screen, in both themes.
import assert from "node:assert/strict";
import { kNarrow, kWide, listViolations, measureOverflow, open, pageOf, settle, testPage } from "./support.mjs";

const kPages = [...["several", "odd", "untrue", "single", "mixed"].map((run) => [run, "index.html"]),
  ...["stress", "bias", "tune"].map((name) => [name, name + ".html"])];

for (const [run, file] of kPages) {
  testPage(`OnEveryScreenInBothThemes_NothingIsInaccessibleOrTooWide: ${run}`, () => open(pageOf(run, file), { waits: false }), async ({ page, shoot }) => {
    const look = async (name) => {
      await settle(page);
      await shoot(`${run}_${name}`);
      assert.ok((await measureOverflow(page)) <= 0, `${name}: the page is wider than the screen`);
    };
    for (const [screen, viewport] of [["wide", kWide], ["narrow", kNarrow]]) {
      await page.setViewportSize(viewport);
      for (const colorScheme of ["dark", "light"]) {
        await page.emulateMedia({ colorScheme });
        await look(`${screen}_${colorScheme}`);
      }
    }
    // What is folded is looked at too. Colours come with the theme and order with the width: two looks have both of each.
    await page.locator("details").evaluateAll((all) => all.forEach((each) => { each.open = true; }));
    for (const [viewport, colorScheme] of [[kNarrow, "light"], [kWide, "dark"]]) {
      await page.setViewportSize(viewport);
      await page.emulateMedia({ colorScheme });
      await look(`unfolded_${colorScheme}`);
      assert.deepEqual(await listViolations(page), [], colorScheme);
    }
  });
}
