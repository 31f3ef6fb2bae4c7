"""Taichi started quicker: the shortcuts are taken, and errors in kernels still say where."""

from __future__ import annotations

import pytest

from runtime.raster.device import start


def test_an_error_in_a_kernel_names_its_place() -> None:
    start("cpu")
    import taichi as ti
    from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

    assert ASTTransformerContext.get_pos_info.__module__ == "runtime.raster.quick"

    @ti.kernel
    def wrong():  # type: ignore[no-untyped-def]
        print(no_such_thing + 1)  # noqa: F821

    with pytest.raises(ti.TaichiNameError, match="no_such_thing") as caught:
        wrong()
    assert f'File "{__file__}", line 19, in wrong' in str(caught.value)
    assert "print(no_such_thing + 1)" in str(caught.value)
