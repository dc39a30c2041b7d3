"""Draws with pyrender's call names: scenes from arrays, a camera's pose, colour and depth.

    from burnish import offscreen as pyrender
    scene = pyrender.Scene(ambient_light=(0.3, 0.3, 0.3))
    scene.add(pyrender.Mesh.from_trimesh(mesh))
    scene.add(pyrender.PerspectiveCamera(yfov=0.8), pose=pose)
    colour, depth = pyrender.OffscreenRenderer(640, 480).render(scene)

A pose is a 4 x 4 matrix in rows. It maps the node's own space to its parent's, or to world space, right-handed with y upwards. Cameras, suns
and spot lights look along their own -z. A call that burnish cannot honour raises burnish.Error, which names the argument.
"""

from .lacking import GLTF, Renderer, Sampler, TextAlign, Viewer
from .meshes import Material, Mesh, MetallicRoughnessMaterial, Primitive, Texture
from .renderer import OffscreenRenderer, RenderFlags
from .scene import Node, Scene
from .views import Camera, DirectionalLight, IntrinsicsCamera, Light, OrthographicCamera, PerspectiveCamera, PointLight, SpotLight

__all__ = ["Camera", "DirectionalLight", "GLTF", "IntrinsicsCamera", "Light", "Material", "Mesh", "MetallicRoughnessMaterial", "Node",
           "OffscreenRenderer", "OrthographicCamera", "PerspectiveCamera", "PointLight", "Primitive", "RenderFlags", "Renderer", "Sampler", "Scene",
           "SpotLight", "TextAlign", "Texture", "Viewer"]
