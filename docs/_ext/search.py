"""The words under which a page is found beside those of its title, and digits in the search."""

from pathlib import Path

__all__ = ["KEYWORDS", "find_digits", "insert_keywords"]

# what people type; each word leads to this page first
KEYWORDS = {
    "add-a-law": ["own law", "plug-in"],
    "angular": ["abrasive", "angular", "sharp particles", "roundness"],
    "app": ["app", "browser", "slider", "GUI"],
    "bearings": ["bearing", "ball bearing", "6205", "ISO 281", "ISO281", "filter", "beta ratio"],
    "big-sweeps": ["sweep", "cluster", "Dask", "Monte Carlo"],
    "bodies": ["Hertz", "Hertz pressure", "force", "newton", "roller"],
    "cases": ["examples", "case", "ball screw", "additive"],
    "changes": ["what's new", "release notes", "breaking changes"],
    "changelog": ["changelog"],
    "choose": ["which model", "choose"],
    "choose-a-law": ["Greenwood-Williamson", "GW", "Jackson-Green", "Kogut-Etsion", "CEB", "JKR",
                     "adhesion"],
    "choose-a-model": ["Series", "Horng2022"],
    "choose-a-seat": ["seat", "valley", "zeta_mean"],
    "cite": ["cite", "citation", "BibTeX", "license", "licence"],
    "columns": ["columns", "results", "output columns"],
    "commands": ["command line", "CLI", "options"],
    "conductance": ["contact resistance", "thermal conductance", "electrical contact"],
    "connector": ["connector", "relay", "switch", "fail to close"],
    "design": ["optimise", "optimize", "optimum", "best size"],
    "dust": ["ISO 4406", "ISO4406", "4406", "NAS 1638", "NAS1638", "AS4059", "ISO 12103",
             "test dust", "particle counter", "concentration", "debris", "contamination"],
    "errata": ["errata", "misprint"],
    "explicit": ["boundary elements", "BEM", "point by point", "height map"],
    "explicit-evidence": ["accuracy of the model", "evidence"],
    "faq": ["FAQ", "questions", "NaN", "no equilibrium", "crowded",
            "gasket", "seal", "leakage", "fretting", "why"],
    "files": ["Excel", "xlsx", "parquet", "CSV", "netCDF", "JSON"],
    "friction": ["friction", "coefficient of friction", "ploughing"],
    "glossary": ["glossary", "p-s", "s-s", "hybrid"],
    "grain": ["breaking", "fracture", "crushing", "quartz", "Weibull strength"],
    "install": ["install", "pip", "Windows", "uv"],
    "life": ["oil life", "filter life", "oil change", "ingress"],
    "lubrication": ["EHL", "EHD", "elastohydrodynamic", "film thickness", "Stribeck",
                    "lambda ratio"],
    "materials": ["hardness", "material"],
    "measurements": ["experiment", "measured"],
    "nomenclature": ["symbols", "notation", "units"],
    "others": ["Tamaas", "ContactMechanics", "SurfaceTopography", "surfalize", "slippy",
               "comparison", "alternatives"],
    "report": ["report", "PDF"],
    "soft": ["wear debris", "squashed", "soft particles", "embedded"],
    "speed": ["speed", "benchmark", "performance"],
    "start": ["getting started", "quickstart", "tutorial", "first steps"],
    "study-file": ["study file", "TOML", "keys", "schema", "input file"],
    "sure": ["how sure", "trust", "limitations"],
    "surfaces": ["Ra", "Rz", "Rq", "profilometer", "AFM", "X3P", "cut-off", "roughness"],
    "tables": ["Abaqus", "COMSOL", "finite elements", "pressure-overclosure"],
    "temperature": ["flash temperature", "heat"],
    "theory": ["assumptions", "equations", "derivation"],
    "uncertainty": ["error bars", "uncertainty", "Sobol", "tornado", "assess"],
    "validation": ["validation", "tests"],
    "wafer": ["wafer", "chuck", "electrostatic", "lithography"],
    "wear-maximum": ["wear maximum", "three-body abrasion"],
    "wear": ["wear", "Archard", "dents"],
}  # fmt: skip


def insert_keywords(text, page):
    """The text of a page with its keywords as entries of the index, after its title."""
    words = KEYWORDS.get(page)
    title, mark, rest = text.partition("\n")
    if not words or not title.startswith("# "):
        return text
    entries = ", ".join(f"! {word}" for word in words)
    return f"{title}{mark}\n```{{index}} {entries}\n```\n{rest}"


# Sphinx leaves words of digits out of a query; here they are codes of standards
DROPS = " || queryTerm.match(/^\\d+$/)"


def find_digits(app, exception):
    """Let the search of the built book take words of digits."""
    file = Path(app.outdir) / "_static" / "searchtools.js"
    if exception or not file.is_file():
        return
    script = file.read_text("utf-8")
    if DROPS not in script:
        raise RuntimeError(f"{file.name} has no {DROPS}: see docs/_ext/search.py")
    file.write_text(script.replace(DROPS, ""), "utf-8")
