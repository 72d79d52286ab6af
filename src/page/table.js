// Tables that sort by a click on a header, and go out as CSV.
{
  const { element } = radiosity;

  // A number where the cell stands for one, its text otherwise.
  const value = (cell) => (cell.dataset.value === undefined ? cell.textContent.trim() : Number(cell.dataset.value));

  // Numbers in their order and before texts; texts as people order them, "9" before "10".
  function order(a, b) {
    if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
    return typeof a === "number" ? a - b : a.localeCompare(b, undefined, { numeric: true });
  }

  function sort(table, column, direction) {
    const body = table.tBodies[0];
    const sign = direction === "ascending" ? 1 : -1;
    const rows = [...body.rows].sort((a, b) => sign * order(value(a.cells[column]), value(b.cells[column])));
    body.append(...rows);
    [...table.tHead.rows[0].cells].forEach((header, i) => {
      header.setAttribute("aria-sort", i === column ? direction : "none");
    });
  }

  function makeSortable(table) {
    [...table.tHead.rows[0].cells].forEach((header, column) => {
      const click = () => {
        const rising = header.getAttribute("aria-sort") === "ascending";
        sort(table, column, rising ? "descending" : "ascending");
      };
      header.setAttribute("aria-sort", "none");
      header.replaceChildren(element("button", { type: "button", onclick: click }, ...header.childNodes));
    });
  }

  const quoted = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

  // Lines end as RFC 4180 has them.
  function csv(table) {
    const lines = [...table.rows].map((row) => [...row.cells].map((cell) => quoted(String(value(cell)))).join(","));
    return lines.map((line) => `${line}\r\n`).join("");
  }

  function download(table, name) {
    const address = URL.createObjectURL(new Blob([csv(table)], { type: "text/csv" }));
    element("a", { href: address, download: name }).click();
    // The browser reads the blob after the click has returned.
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  }

  for (const figure of document.querySelectorAll("figure.table")) {
    const table = figure.querySelector("table");
    makeSortable(table);
    const name = table.dataset.file;
    const save = element("button", { type: "button", onclick: () => download(table, name) }, "Download CSV");
    figure.append(element("div", { class: "controls" }, save));
  }
}
