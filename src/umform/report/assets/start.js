// Bring the page to life; what cannot be shown here leaves its still picture in place.

function alive(id) {
  element(id).hidden = false;
  element(id).closest(".either").classList.add("alive");
}

// All rows of the history, once they are asked for.
function fillTable(table) {
  const body = element("history-rows");
  if (body.children.length) return;
  for (let row = 0; row < table.length; row += 1) {
    const line = body.insertRow();
    for (const name of table.names) {
      const cell = line.insertCell();
      cell.textContent = digits(table.columns[name][row]);
      cell.title = String(table.columns[name][row]);
    }
  }
}

// A later state of the same run, in place: what was chosen stays.
async function renew(packed, table) {
  await begun; // a state that comes while the page begins is not lost
  const { shape, curves } = window.umform;
  const scene = shape && (await unpacked(packed));
  curves.renew(table); // the frames of the scene are rows of it
  if (shape) shape.renew(scene);
}

async function start() {
  const table = history();
  element("history-all").addEventListener("toggle", () => fillTable(table));
  alive("curves");
  const colours = JSON.parse(element("curves-plot").dataset.colours);
  window.umform = { table, curves: new Curves(table, colours), renew };
  try {
    await started("three");
    const scene = await unpacked(element("scene").textContent);
    alive("shape");
    window.umform.shape = new ShapeView(scene);
  } catch (problem) {
    element("shape").hidden = true;
    element("shape").closest(".either").classList.remove("alive");
    element("shape-problem").hidden = false;
    element("shape-problem").append(` (${problem.message})`);
  }
  document.documentElement.dataset.ready = "yes";
}

const begun = start();
