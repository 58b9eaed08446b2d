// Whether Stop is seen and nothing covers it, at its centre and near its corners; what is wrong otherwise.
const stop = document.querySelector(".nao-stop"), box = stop.getBoundingClientRect(), wrong = [];
if (!stop.checkVisibility({ opacityProperty: true, visibilityProperty: true })) wrong.push("it is not visible");
if (box.width < 44 || box.height < 44) wrong.push(`it has ${box.width} x ${box.height} pixels`);
if (box.left < 0 || box.top < 0 || box.right > innerWidth || box.bottom > innerHeight) wrong.push("it is outside");
const across = [box.left + 4, (box.left + box.right) / 2, box.right - 4];
const down = [box.top + 4, (box.top + box.bottom) / 2, box.bottom - 4];
for (const x of across) for (const y of down) {
  const there = document.elementFromPoint(x, y);
  if (!stop.contains(there)) wrong.push(`at ${x - box.left}, ${y - box.top} there is ${there?.className || there?.tagName}`);
}
return wrong;
