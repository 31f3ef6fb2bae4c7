"""The Taichi rasteriser: batches of views of skinned scenes to pictures."""

from .types import Camera, Frames, RenderScene, Style, Views

__all__ = ["Camera", "Frames", "RenderScene", "Style", "Views"]
