/* A switch between the versions that stand beside this book, from ../versions.js. */
document.querySelectorAll(".book-version").forEach((place) => {
  const versions = window.BOOK_VERSIONS || [];
  if (versions.length < 2 || place.querySelector("select")) return;
  const choice = document.createElement("select");
  choice.setAttribute("aria-label", "version of this book");
  versions.forEach((version) => {
    const option = new Option(`version ${version}`, version);
    option.selected = version === place.dataset.version;
    choice.add(option);
  });
  choice.addEventListener("change", () => {
    window.location.href = `${place.dataset.root}../${choice.value}/index.html`;
  });
  place.replaceChildren(choice);
});
