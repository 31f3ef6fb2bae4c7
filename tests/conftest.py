"""What holds for all tests: nothing comes from results that earlier runs kept, unless a test asks for it."""

import os

import pytest

os.environ["VDS_CACHE_MIB"] = "0"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files with a slow test come first: begun last, one would leave the other workers idle."""
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: item.path not in slow)
