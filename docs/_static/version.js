/* A switch between the versions that stand beside this book, from ../versions.js. It leads to the
   same page of the other version, or to its first page where that version has no such page. */
document.querySelectorAll(".book-version").forEach((place) => {
  const versions = window.BOOK_VERSIONS || [];
  if (versions.length < 2 || place.querySelector("select")) return;
  const { version: own, root, page } = place.dataset;
  const choice = document.createElement("select");
  choice.setAttribute("aria-label", "version of this book");
  versions.forEach((version) => {
    const option = new Option(`version ${version}`, version);
    option.selected = version === own;
    choice.add(option);
  });
  choice.addEventListener("change", async () => {
    const book = `${root}../${choice.value}`;
    choice.value = own; // what this page is when the reader comes back to it
    let target = `${book}/index.html`;
    try {
      const same = await fetch(`${book}/${page}.html`, { method: "HEAD" });
      if (same.ok) target = `${book}/${page}.html`;
    } catch {
      // files that are opened without a server: nobody can say whether the page is there
    }
    window.location.href = target;
  });
  place.replaceChildren(choice);
});
