// What is hard to read or has no name on a page: texts with less contrast than WCAG 2.1 AA asks for, and controls that
// nothing names. Returns texts for people.

const luminance = (color) => {
  const [r, g, b] = color.slice(0, 3).map((part) => {
    const value = part / 255;
    return value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const parsed = (text) => {
  const parts = text.match(/rgba?\(([^)]+)\)/)?.[1].split(/[ ,/]+/).map(Number);
  return parts && [...parts.slice(0, 3), parts[3] ?? 1];
};
const over = (above, below) => [0, 1, 2].map((i) => above[i] * above[3] + below[i] * (1 - above[3])).concat(1);
const outer = (element) => element.parentElement ?? element.getRootNode().host;

function behind(element) {
  const layers = [];
  for (let each = element; each; each = outer(each)) {
    const color = parsed(getComputedStyle(each).backgroundColor);
    if (color?.[3] > 0) layers.push(color);
    if (color?.[3] === 1) break;
  }
  const page = document.body.classList.contains("body--dark") ? [18, 18, 18, 1] : [255, 255, 255, 1];
  return layers.reverse().reduce((below, layer) => over(layer, below), page);
}

function opacity(element) {
  let product = 1;
  for (let each = element; each; each = outer(each)) product *= parseFloat(getComputedStyle(each).opacity);
  return product;
}

function contrast(element) {
  const color = parsed(getComputedStyle(element).color);
  const below = behind(element);
  const above = over([...color.slice(0, 3), color[3] * opacity(element)], below);
  const [light, dark] = [luminance(above), luminance(below)].sort((a, b) => b - a);
  return (light + 0.05) / (dark + 0.05);
}

for (const each of document.getAnimations()) { // colours that change are read as they will be
  if (Number.isFinite(each.effect.getComputedTiming().endTime)) each.finish();
}
const found = [];
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
  const text = walker.currentNode.data.trim(), element = walker.currentNode.parentElement;
  if (!text || !element?.checkVisibility({ visibilityProperty: true })) continue;
  if (element.closest("[disabled], .disabled, [aria-disabled=true], .q-icon, .q-notification")) continue;
  const style = getComputedStyle(element), size = parseFloat(style.fontSize);
  const needed = size >= 24 || (size >= 18.6 && Number(style.fontWeight) >= 700) ? 3 : 4.5;
  const ratio = contrast(element);
  if (ratio < needed) found.push(`${text.slice(0, 40)}: contrast ${ratio.toFixed(2)}`);
}
for (const control of document.querySelectorAll("button, a[href], input, select, textarea, [role=button]")) {
  if (!control.checkVisibility({ visibilityProperty: true })) continue;
  const words = [...control.querySelectorAll("*"), control]
    .filter((each) => !each.closest(".q-icon"))
    .flatMap((each) => [...each.childNodes].filter((node) => node.nodeType === 3).map((node) => node.data.trim()));
  const name = control.ariaLabel || control.title || control.labels?.[0]?.innerText || words.join("");
  if (!name) found.push(`no name: ${control.outerHTML.slice(0, 120)}`);
}
return found;
