// Tables that sort by a column, and data to take away.
import { marked } from "marked";

const number = (text) => {
  const found = text.replace(/[,%*]/g, "").match(/^\s*[-+]?(\d[\d.]*(e[-+]?\d+)?|inf)/i);
  return found ? Number(found[0].trim().replace(/inf/i, "Infinity")) : null;
};

function compare(a, b) {
  const x = number(a), y = number(b);
  if (x !== null && y !== null) return x - y;
  return x !== null ? -1 : y !== null ? 1 : a.localeCompare(b);
}

function sortable(table) {
  table.querySelectorAll("thead th").forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    head.replaceChildren(button);
    button.addEventListener("click", () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      head.parentElement.querySelectorAll("th").forEach((th) => th.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const text = (row) => row.cells[column].textContent;
      const rows = [...table.tBodies[0].rows].sort((a, b) => (up ? 1 : -1) * compare(text(a), text(b)));
      table.tBodies[0].append(...rows);
    });
  });
}

export function save(name, text, type = "text/csv") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export function csv(rows) {
  const columns = [...new Set(rows.flatMap(Object.keys))].filter((c) => rows.every((r) => typeof r[c] !== "object" || r[c] === null));
  const cell = (value) => /[",\n]/.test(`${value ?? ""}`) ? `"${`${value}`.replaceAll('"', '""')}"` : `${value ?? ""}`;
  return [columns, ...rows.map((r) => columns.map((c) => r[c]))].map((row) => row.map(cell).join(",")).join("\n") + "\n";
}

const csvOf = (table) => [...table.rows].map((row) => [...row.cells].map((cell) => `"${cell.textContent.replaceAll('"', '""')}"`).join(",")).join("\n") + "\n";

// Markdown as elements; each table with a button for its data.
export function fromMarkdown(text, name) {
  const box = document.createElement("div");
  box.innerHTML = marked.parse(text);
  box.querySelectorAll("table").forEach((table, i) => {
    sortable(table);
    const wide = document.createElement("div");
    wide.className = "wide";
    table.replaceWith(wide);
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "CSV";
    button.addEventListener("click", () => save(`${name}-${i + 1}.csv`, csvOf(table)));
    wide.append(table);
    wide.after(button);
  });
  return box;
}
