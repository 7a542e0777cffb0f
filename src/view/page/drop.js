// SPDX-License-Identifier: GPL-3.0-or-later
// Uploads files dropped onto the page, or chosen, and asks the server to open them.

const kMostFiles = 256, kMostBytes = 2 ** 31;  // as the server takes

// Files of a folder and its folders, as {name, file}; the name has the folders.
async function filesOf(entry) {
  if (entry.isFile) return [{name: entry.fullPath.slice(1), file: await new Promise((done, failed) => entry.file(done, failed))}];
  const reader = entry.createReader(), files = [];
  for (;;) {
    const entries = await new Promise((done, failed) => reader.readEntries(done, failed));  // some at a time
    if (!entries.length) return files;
    for (const child of entries) files.push(...await filesOf(child));
  }
}

async function droppedFiles(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);  // before any wait
  if (!entries.length) return [...transfer.files].map((file) => ({name: file.name, file}));
  return (await Promise.all(entries.map(filesOf))).flat();
}

export class Drop {
  // root: element receiving files; send(message): to the server; tell(text, isGood): shows a line
  constructor(root, send, tell) {
    Object.assign(this, {send, tell});
    const hasFiles = (event) => event.dataTransfer?.types.includes("Files");
    const mark = (isOver) => root.classList.toggle("is-over", isOver);
    root.addEventListener("dragover", (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      mark(true);
    });
    root.addEventListener("dragleave", (event) => { if (!event.relatedTarget) mark(false); });
    root.addEventListener("drop", async (event) => {
      mark(false);
      if (!hasFiles(event)) return;
      event.preventDefault();
      this.open(await droppedFiles(event.dataTransfer));
    });
  }

  // files: as {name, file}; hidden ones are left out
  async open(files) {
    const seen = files.filter(({name}) => !name.split("/").some((part) => part.startsWith(".")));
    if (!seen.length) return;
    const bytes = seen.reduce((sum, {file}) => sum + file.size, 0);
    if (seen.length > kMostFiles || bytes > kMostBytes) return this.tell("a drop has at most 256 files and 2 GiB", false);
    const drop = String(Math.floor(Math.random() * 2 ** 52));
    for (const [index, {name, file}] of seen.entries()) {
      this.tell(`uploading ${name} (${index + 1} of ${seen.length})`);
      const answer = await fetch(`dropped/${drop}/${index}`, {method: "PUT", body: file}).catch(() => null);
      if (!answer?.ok) return this.tell(answer ? await answer.text() : `${name}: the upload failed`, false);
    }
    this.send({do: "open", drop, names: seen.map(({name}) => name)});
  }
}
