"""Taichi kernels. Import only after deciding to render: every module here imports taichi."""
