// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el } from "../dom.ts";
import { fileName, save } from "../save.ts";
import { svg } from "../svg.ts";
import { palette } from "../theme.ts";

/** What the style sheet says of a drawing, and a file of its own has to say itself. */
const carried = ["fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "fill-opacity", "font-size", "font-weight", "text-anchor"] as const;

const boxOf = (drawing: SVGElement): [x: number, y: number, width: number, height: number] =>
  (drawing.getAttribute("viewBox") ?? "0 0 640 400").split(" ").map(Number) as [number, number, number, number];

/** The drawing as a file that looks the same without this page. */
export function standalone(drawing: SVGElement): string {
  const copy = drawing.cloneNode(true) as SVGElement;
  const [from, to] = [[drawing, ...drawing.querySelectorAll("*")], [copy, ...copy.querySelectorAll("*")]];
  from.forEach((node, i) => {
    const style = getComputedStyle(node);
    for (const name of carried) {
      const value = style.getPropertyValue(name);
      if (value !== "") (to[i] as Element).setAttribute(name, value);
    }
    (to[i] as Element).removeAttribute("class");
  });
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("font-family", "system-ui, sans-serif");
  const [x, y, width, height] = boxOf(drawing);
  copy.prepend(svg("rect", { x, y, width, height, fill: palette().background }));
  return new XMLSerializer().serializeToString(copy);
}

/** The same as a picture, twice as fine as the drawing says. */
async function picture(drawing: SVGElement): Promise<Blob | null> {
  const box = boxOf(drawing);
  const image = new Image(2 * box[2], 2 * box[3]);
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(standalone(drawing))}`;
  await image.decode();
  const canvas = el("canvas", { width: 2 * box[2], height: 2 * box[3] });
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = palette().background;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}

/** A drawing with its words above it and buttons that save it. */
export function svgFigure(caption: string, drawing: SVGElement, ...below: (Node | string)[]): HTMLElement {
  const name = (ending: string): string => fileName(`${document.title.split(" · ")[0] ?? ""}_${caption}`, ending);
  const tools = el(
    "span",
    { class: "figure-tools" },
    el("button", { type: "button", title: "Save this figure as a drawing", click: () => save(name("svg"), new Blob([standalone(drawing)], { type: "image/svg+xml" })) }, "SVG"),
    el("button", { type: "button", title: "Save this figure as a picture", click: () => void picture(drawing).then((blob) => blob !== null && save(name("png"), blob)) }, "PNG"),
  );
  const box = el("div", { class: "drawing", tabindex: 0, role: "group", "aria-label": caption });
  box.append(drawing);
  return el("figure", { class: "plot drawn" }, el("figcaption", {}, caption), box, tools, ...below);
}
