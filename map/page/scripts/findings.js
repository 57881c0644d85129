// The list of findings (or changes): by severity and rule, one after the other.

function countBy(remarks, key) {
  const counts = new Map();
  for (const one of remarks) counts.set(one[key], (counts.get(one[key]) ?? 0) + 1);
  return counts;
}

function shownRemarks(map) {
  return map.remarks.map((_, index) => index).filter((index) => !map.hiddenRules.has(map.remarks[index].rule));
}

function listRules(page) {
  const {map} = page, list = element("rules");
  const isGraver = (a, b) => SEVERITIES.indexOf(a) < SEVERITIES.indexOf(b), severityOf = new Map();
  for (const {rule, severity} of map.remarks) {
    if (!severityOf.has(rule) || isGraver(severity, severityOf.get(rule))) severityOf.set(rule, severity);
  }
  const rules = [...countBy(map.remarks, "rule")].sort((a, b) =>
      SEVERITIES.indexOf(severityOf.get(a[0])) - SEVERITIES.indexOf(severityOf.get(b[0])) || b[1] - a[1]);
  for (const [rule, count] of rules) {
    const label = addText(list, "label", "", ""), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => {
      if (box.checked) map.hiddenRules.delete(rule); else map.hiddenRules.add(rule);
      repaint(page);
    });
    const mark = document.createElement("i");
    mark.className = "swatch " + severityOf.get(rule);
    label.append(box, mark, `${rule} (${count})`);
  }
}

/** The next finding after the selected one, or the one before. */
function nextRemark(page, step) {
  const {map, selection} = page, shown = shownRemarks(map);
  if (shown.length === 0) return say(page, "there is none");
  const now = selection?.kind === "remark" ? shown.indexOf(selection.index) : step > 0 ? -1 : 0;
  visit(page, {kind: "remark", index: shown[(now + step + shown.length) % shown.length]});
}

function makeFindings(page) {
  const {map} = page, counts = countBy(map.remarks, "severity");
  const words = SEVERITIES.filter((one) => counts.has(one)).map((one) => `${counts.get(one)} ${one}`);
  element("remarks_title").textContent = `${map.remarksTitle}: ${words.join(", ") || "none"}`;
  element("next").addEventListener("click", () => nextRemark(page, 1));
  element("previous").addEventListener("click", () => nextRemark(page, -1));
  element("next").disabled = element("previous").disabled = map.remarks.length === 0;
  listRules(page);
}
