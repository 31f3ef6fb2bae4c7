"""Several processes test at a time: networks that each want all cores would wait for one another."""

import os

import pytest
import torch


@pytest.fixture(autouse=True)
def _one_thread_each(monkeypatch: pytest.MonkeyPatch) -> None:
    if "PYTEST_XDIST_WORKER" in os.environ:
        monkeypatch.setattr("ranker.infer.CPU_THREADS", 1)
        torch.set_num_threads(1)
