// Starts what a run's page has room for. Charts and the table open the viewer.
if (run.cells.some(({ picture, values }) => picture || values)) {
  shadowbench.openViewer = async ({ rect, ...changes }) => {
    section.scrollIntoView();
    await change(Object.fromEntries(Object.entries(changes).filter(([, value]) => value !== undefined)));
    if (rect) showRect(rect);
  };
  shadowbench.openCell = (key) => {
    const cell = run.cells.find((each) => each.key === key);
    if (cell) shadowbench.openViewer({ place: cell.place, right: cell.configuration });
  };
  new ResizeObserver(() => requestAnimationFrame(fitCanvases)).observe(paneBox);
  window.addEventListener("hashchange", openLink);
  const [first = kTruth, second = first] = listAll(0);
  if (!openLink()) start({ place: 0, left: first, right: second });
} else section.hidden = true;
if (timesHere() && run.scopes.length > 0) addMachine(timesHere(), true);
for (const [name, begin] of [
  [".numbers", startTable],
  [".answer", startAnswer],
  [".live", startLive],
]) {
  const holder = document.querySelector(name);
  if (holder) begin(holder);
}
