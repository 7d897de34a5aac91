// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

const shapes = new Set(["svg", "g", "path", "polyline", "polygon", "line", "circle", "ellipse", "rect", "text", "tspan", "title"]);
const words = new Set(["p", "b", "i", "em", "strong", "sub", "sup", "span"]);
const kept = new Set([
  "viewbox", "width", "height", "d", "points", "x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "r", "rx", "ry", "fill", "stroke",
  "stroke-width", "stroke-dasharray", "stroke-linecap", "stroke-linejoin", "opacity", "fill-opacity", "transform", "text-anchor",
  "font-size", "font-weight", "class", "role", "aria-label", "dy", "dx",
]);

/** Drawings and words that the program wrote as markup: known elements with known attributes, nothing else. */
export function foreign(markup: string): (HTMLElement | SVGElement | Text)[] {
  // Handlers go first: the parser would already complain of them under the page's policy.
  const quiet = markup.replaceAll(/\son\w+\s*=\s*("[^"]*"|'[^']*'|[^\s>]+)/gi, "");
  const parsed = new DOMParser().parseFromString(quiet, "text/html");
  return [...parsed.body.childNodes].flatMap((node) => copied(node));
}

function copied(node: Node): (HTMLElement | SVGElement | Text)[] {
  if (node.nodeType === Node.TEXT_NODE) return [document.createTextNode(node.textContent ?? "")];
  if (!(node instanceof Element)) return [];
  const tag = node.localName;
  const isShape = node.namespaceURI === "http://www.w3.org/2000/svg" && shapes.has(tag);
  if (!isShape && !words.has(tag)) return [];
  const made = isShape ? document.createElementNS("http://www.w3.org/2000/svg", tag) as SVGElement : document.createElement(tag);
  for (const { name, value } of node.attributes) if (kept.has(name.toLowerCase()) && !/url\(/i.test(value)) made.setAttribute(name, value);
  made.append(...[...node.childNodes].flatMap((child) => copied(child)));
  return [made];
}
