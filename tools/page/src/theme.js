// How charts look on a light or a dark page of some width.
export function theme(dark, width) {
  const text = dark ? "#e6e6e6" : "#222", line = dark ? "#444" : "#ddd";
  const axis = { labelColor: text, titleColor: text, gridColor: line, domainColor: line, tickColor: line, titleFontWeight: "normal" };
  return {
    background: null,
    font: "system-ui, sans-serif",
    view: { stroke: line },
    axis,
    legend: { labelColor: text, titleColor: text, orient: "top", columns: Math.max(2, Math.min(8, Math.floor(width / 150))), symbolOpacity: 1 },
    header: { labelColor: text, titleColor: text },
    text: { color: text },
    title: { color: text },
  };
}
