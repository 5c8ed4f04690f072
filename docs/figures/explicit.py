"""Draw explicit.png of the page on particles at their places, from the states that ship."""

import json
import math
from importlib import resources
from pathlib import Path

from PIL import Image

from thirdbody.papers.explicit import CASES
from thirdbody.papers.explicit.compared import Point
from thirdbody.papers.explicit.page import figure

RATIOS = (
    "bare_over_bearing",
    "particles_over_sum",
    "asperities_with_over_without",
    "bearing_over_gaussian",
)


def points() -> tuple[Point, ...]:
    """The pressed states, with the law of summits and that of one field beside them."""
    text = resources.files("thirdbody").joinpath("data/explicit_comparison.json").read_text("utf-8")
    cases = {case.name: case for case in CASES}

    def pair(state: dict, name: str, error: str) -> tuple[float, float]:
        return tuple(math.nan if state[key] is None else state[key] for key in (name, error))

    return tuple(
        Point(
            case=cases[state["case"]],
            F_star=state["F_star"],
            raw=pair(state, "share_raw", "share_raw_error"),
            share=pair(state, "share", "share_error"),
            statistical=state["share_statistical"],
            h=pair(state, "h_over_sigma", "h_over_sigma_error"),
            h_statistical=state["h_over_sigma_statistical"],
            area=pair(state, "A_t", "A_t_error"),
            area_statistical=state["A_t_statistical"],
            ratios={name: state[name] for name in RATIOS},
            model_bare=state["bare_over_bearing_statistical"],
            surfaces=8,
            zeta=(state["zeta_mean"], state["zeta_std"]),
            stored=None,
            bounds=pair(state, "share_least", "share_most"),
            field=(state["share_field"], state["h_over_sigma_field"], state["A_t_field"]),
        )
        for state in json.loads(text)["states"]
    )


if __name__ == "__main__":
    path = Path(__file__).with_name("explicit.png")
    figure(points()).savefig(path, dpi=120, facecolor="white")
    image = Image.open(path).convert("RGB").quantize(256, dither=Image.Dither.NONE)
    image.save(path, optimize=True)
    print(path.name, image.size, path.stat().st_size, "bytes")
