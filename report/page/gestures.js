"use strict";
// Pointers, fingers and the wheel over the viewer's panes, as what they do to a view.
(() => {
  const shadowbench = (window.shadowbench = window.shadowbench || {});
  // `view` offers locate(), point(), pan(), zoomBy(), isFitted(), hitsSplit(), setSplit(), wantsCrop(), drawCrop() and endCrop().
  shadowbench.listenToPointers = (canvases, view) => {
    const fingers = new Map();
    let gesture = null;
    const pinch = (canvas) => {
      const [a, b] = [...fingers.values()], apart = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
      const middle = { clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 };
      if (gesture.apart) view.zoomBy(apart / gesture.apart, view.locate(canvas, middle));
      gesture = { kind: "pinch", apart };
    };
    const move = (canvas, event) => {
      const now = view.locate(canvas, event);
      if (!gesture) return view.point(now);
      if (fingers.has(event.pointerId)) fingers.set(event.pointerId, event);
      if (fingers.size === 2) return pinch(canvas);
      if (gesture.kind === "split") view.setSplit(canvas, event);
      else if (gesture.kind === "crop") view.drawCrop(gesture.from, now);
      else if (gesture.kind === "pan") {
        view.pan((gesture.at.clientX - event.clientX) * now.step, (gesture.at.clientY - event.clientY) * now.step);
        gesture.at = event;
      }
    };
    for (const canvas of canvases) {
      canvas.addEventListener("pointerdown", (event) => {
        const from = view.locate(canvas, event);
        canvas.setPointerCapture(event.pointerId);
        fingers.set(event.pointerId, event);
        gesture = { kind: view.wantsCrop(event) ? "crop" : view.hitsSplit(canvas, event) ? "split" : "pan", at: event, from };
        view.point(from);
      });
      canvas.addEventListener("pointermove", (event) => move(canvas, event));
      for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => {
        fingers.delete(event.pointerId);
        if (gesture?.kind === "crop") view.endCrop();
        gesture = fingers.size > 0 ? { kind: "rest" } : null;
      });
      canvas.addEventListener("wheel", (event) => {
        if (view.isFitted() && event.deltaY > 0) return;  // the page scrolls on
        event.preventDefault();
        view.zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : event.ctrlKey ? 0.01 : 0.002)), view.locate(canvas, event));
      }, { passive: false });
    }
  };
})();
