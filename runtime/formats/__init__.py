"""Files of other programs: models (.glb, .gltf, .obj, .ply, .stl), figures (.glb) and motion (.bvh, .glb).

What is read here is not trusted. Every file is bounded before anything is made of what it declares, nothing
outside the project's folder is opened, and all that can be wrong with one is a
:class:`runtime.formats.errors.ModelFileError`.
"""
