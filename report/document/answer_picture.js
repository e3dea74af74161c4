// The picture of the answer: the truth at the left of a line that the reader moves, a filter at the right, where the
// filter's picture differs most.
const startPicture = (holder) => {
  const figure = element(holder, "figure", { className: "split" });
  const stage = element(figure, "div", { className: "stage" });
  const images = [0, 1].map(() => element(stage, "img", { alt: "" }));
  const line = element(stage, "i");
  const slider = element(stage, "input", { type: "range", min: 0, max: 100, value: 50 });
  slider.addEventListener("input", () => stage.style.setProperty("--split", `${slider.value}%`));
  const caption = element(figure, "figcaption");
  let shown = null;
  const button = addButton(figure, "Look closer", () => shadowbench.openViewer(shown));
  const live = addButton(figure, "Live", () => shadowbench.showLive(shown), "Drawn by this GPU");
  const message = element(figure, "p", { className: "note" });

  const show = (index, place) => {
    const cell = cellAt(index, place);
    const { picture, truth } = cell.smooth ?? { picture: cell.picture, truth: run.truths[place]?.picture };
    const [wholeWidth] = run.configurations[index].size;
    const [x, y, width, height] = cell.part;
    const hasBoth = Boolean(truth && picture);
    shown = { place, left: truth ? kTruth : index, right: index, layer: "picture", rect: { x, y, width, height } };
    stage.style.aspectRatio = `${width}/${height}`;
    stage.style.setProperty("--before", `${(100 * x) / wholeWidth}%`); // what the stage hides at its left
    stage.style.setProperty("--share", width / wholeWidth);
    [truth, picture].forEach((path, i) => {
      images[i].hidden = !path;
      if (path && images[i].getAttribute("src") !== path) images[i].src = path;
      images[i].alt = `${i === 0 ? "truth" : nameOf(index)} on ${run.places[place].title}`;
    });
    for (const { style } of images) {
      style.width = `${(100 * wholeWidth) / width}%`;
      style.left = `${(-100 * x) / width}%`;
      style.top = `${(-100 * y) / height}%`;
    }
    stage.classList.toggle("single", !hasBoth);
    slider.hidden = line.hidden = !hasBoth;
    stage.hidden = caption.hidden = button.hidden = !truth && !picture;
    const name = `${nameOf(index)} on ${run.places[place].title}`;
    slider.setAttribute("aria-label", `How much of the truth is seen beside ${name}`);
    caption.replaceChildren();
    for (const text of hasBoth ? ["truth", name] : [truth ? "truth" : name]) element(caption, "bdi", {}, text);
    const samples = cell.smooth ? `${cell.smooth.samples} samples a pixel; errors are of one.` : "";
    message.textContent = truth || picture ? samples : "This run stored no images.";
    live.hidden = !cell.frames;
  };
  images.forEach((image) =>
    image.addEventListener("error", () => {
      message.textContent = `${image.getAttribute("src")} cannot be read: the file is not beside this page.`;
    }),
  );
  return { figure, show };
};

// A command that can be copied; gives the element that it stands in.
const addCommand = (holder, lead) => {
  const line = element(holder, "p", { className: "note" }, lead);
  const code = element(line, "code");
  line.append(" ");
  addButton(line, "Copy", () => navigator.clipboard?.writeText(code.textContent));
  return code;
};

// The commands that say and show the same: the run's folder is that of the page, seen from beside it.
const writeWord = (word) => (/^[\w./+:,=-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
const folderOfPage = () =>
  writeWord(location.protocol === "file:" ? decodeURI(location.pathname).split("/").at(-2) : "RUN");
// Empty where it is not known how the scene, or the file of a filter, was given.
const writeView = (index, place) => {
  const { filter, request, map } = run.configurations[index];
  const { view } = run.places[place];
  const file = run.files[filter];
  if (view.length === 0 || file === null) return "";
  const own = file ? ["--filter-file", file] : [];
  const words = [...view, ...own, "--left", "truth", "--right", request, "--map-size", map];
  return `shadowbench view ${words.map((word) => writeWord(`${word}`)).join(" ")}`;
};
