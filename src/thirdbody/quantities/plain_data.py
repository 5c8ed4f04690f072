"""Results as plain data, ready for JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

__all__ = ["plain_data"]


def plain_data(value: object) -> Any:
    """Numbers, texts, lists and dicts, with None for numbers that are not finite.

    What has a `to_dict` says itself what it is as plain data.

    >>> import numpy as np
    >>> plain_data({"A_t": np.array([0.1, np.nan]), "mode": ("p-s", None), "n": np.int64(3)})
    {'A_t': [0.1, None], 'mode': ['p-s', None], 'n': 3}
    """
    if isinstance(value, Mapping):
        return {key: plain_data(element) for key, element in value.items()}
    if hasattr(value, "to_dict"):
        return plain_data(value.to_dict())
    if hasattr(value, "tolist"):  # an array or a number of NumPy, which is not loaded for this
        return plain_data(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain_data(element) for element in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
