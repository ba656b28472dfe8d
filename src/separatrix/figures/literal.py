"""Text of users in figures: matplotlib takes what stands between dollar signs for a formula."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr


def literal(text: str) -> str:
    """Return a text that a figure writes as it is."""
    return text.replace("$", r"\$")


def literal_texts(data: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose texts, title and study a figure writes as they are."""
    texts = {name: _literal_array(one) for name, one in data.variables.items() if one.dtype.kind in "OU"}
    found = data.assign({name: one for name, one in texts.items() if "$" in str(one.values)})
    found.attrs = {name: _literal_attribute(name, value) for name, value in data.attrs.items()}
    return found


def _literal_array(variable: xr.Variable) -> xr.Variable:
    values = [literal(one) if isinstance(one, str) else one for one in variable.values.ravel().tolist()]
    shaped = np.array([*values, None], dtype=object)[:-1].reshape(variable.shape)
    return xr.Variable(variable.dims, shaped, variable.attrs)


def _literal_attribute(name: object, value: Any) -> Any:
    """The study is JSON, where a backslash is written twice."""
    if not isinstance(value, str):
        return value
    return value.replace("$", r"\\$") if name == "study" else literal(value)
