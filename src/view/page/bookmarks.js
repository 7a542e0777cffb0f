// SPDX-License-Identifier: GPL-3.0-or-later
// Numbered views of the free camera, kept by the browser for each scene.

const kMost = 9;

export class Bookmarks {
  // root: receives a button a view; recall(look): shows a view; tell(text): shows a line
  constructor(root, recall, tell) {
    Object.assign(this, {root, recall, tell, key: "", views: {}});
  }

  // path: of the scene
  open(path) {
    this.key = `opaline view ${path}`;
    try {
      this.views = JSON.parse(localStorage.getItem(this.key)) || {};
    } catch {  // none, or no storage
      this.views = {};
    }
    this.show();
  }

  // number: 1 to 9; none: the first free one, or the last
  store(look, number) {
    const free = Array.from({length: kMost}, (_, i) => i + 1).find((n) => !(n in this.views)) ?? kMost;
    this.views[number ?? free] = look;
    try {
      localStorage.setItem(this.key, JSON.stringify(this.views));
    } catch {  // kept until the page is closed
    }
    this.tell(`view ${number ?? free} is stored`);
    this.show();
  }

  go(number) {
    if (number in this.views) this.recall(this.views[number]);
    else this.tell(`there is no view ${number}: Shift+${number} stores it`);
  }

  show() {
    this.root.replaceChildren(...Object.keys(this.views).map((number) => {
      const button = Object.assign(document.createElement("button"), {type: "button", textContent: number, title: `View ${number} (key ${number})`, onclick: () => this.go(number)});
      button.setAttribute("aria-label", `View ${number}`);
      return button;
    }));
  }
}
