"""A scene of meshes, lights and cameras, each with a pose."""

from . import gltf
from .checks import check_rotation, colour, matrix, refuse, refuse_given
from .meshes import Mesh
from .views import CAMERAS, Light

IDENTITY = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))


class Node:
    """A mesh, camera or light in a scene. matrix: its pose, 4 rows of 4 numbers."""

    def __init__(self, name=None, camera=None, children=None, mesh=None, light=None, matrix=None):
        refuse_given(children=children)
        if sum(thing is not None for thing in (camera, mesh, light)) != 1:
            refuse("node", "it holds one mesh, camera or light")
        self.name, self.camera, self.mesh, self.light = name, camera, mesh, light
        self.matrix = IDENTITY if matrix is None else matrix

    @property
    def matrix(self):
        return self._matrix

    @matrix.setter
    def matrix(self, pose):
        columns = matrix(pose, "pose")
        if self.mesh is None:
            check_rotation(columns, "pose")
        self._matrix, self.columns = pose, columns


class Scene:
    """Things with poses, in world space: metres, right-handed, y upwards.

    bg_color: display colour behind the things, 3 or 4 floats of 0 to 1 (white). ambient_light: radiance from everywhere, 3 floats (none).
    environment: a picture's path or "builtin:NAME" that lights the things, in place of ambient_light; shown where bg_color is None.
    """

    def __init__(self, nodes=None, bg_color=None, ambient_light=None, name=None, *, environment=None):
        if environment is not None:
            refuse_given(ambient_light=ambient_light)
        self.environment, self.name = environment, name
        self.bg_color = [1.0] * 4 if bg_color is None and environment is None else bg_color
        self.ambient_light = [0.0] * 3 if ambient_light is None else ambient_light
        self.nodes, self.main_camera_node = [], None
        for node in nodes or ():
            self.add_node(node)

    bg_color = property(lambda self: self._bg, lambda self, value: setattr(self, "_bg", None if value is None else colour(value, "bg_color", 1)))
    ambient_light = property(lambda self: self._ambient, lambda self, value: setattr(self, "_ambient", colour(value, "ambient_light")[:3]))
    mesh_nodes = property(lambda self: [node for node in self.nodes if node.mesh is not None])
    camera_nodes = property(lambda self: [node for node in self.nodes if node.camera is not None])
    light_nodes = property(lambda self: [node for node in self.nodes if node.light is not None])

    def add(self, obj, name=None, pose=None, parent_node=None, parent_name=None):
        """Adds a Mesh, a camera or a light. pose: 4 rows of 4 numbers, to world space; None: the identity. Returns its Node."""
        refuse_given(parent_node=parent_node, parent_name=parent_name)
        kind = "mesh" if isinstance(obj, Mesh) else "light" if isinstance(obj, Light) else "camera" if isinstance(obj, CAMERAS) else None
        if kind is None:
            refuse("obj", f"a {type(obj).__name__} is no mesh, camera or light")
        return self.add_node(Node(name, matrix=pose, **{kind: obj}))

    def add_node(self, node):
        """Adds a Node. The first camera is the main one. Returns the node."""
        self.nodes.append(node)
        if node.camera is not None and self.main_camera_node is None:
            self.main_camera_node = node
        return node

    def has_node(self, node):
        return any(node is other for other in self.nodes)

    def remove_node(self, node):
        """Removes a node. Raises burnish.Error where the scene lacks it."""
        if not self.has_node(node):
            refuse("node", "the scene does not have it")
        self.nodes = [other for other in self.nodes if other is not node]
        if self.main_camera_node is node:
            self.main_camera_node = next(iter(self.camera_nodes), None)

    def set_pose(self, node, pose):
        """Moves a node. pose: 4 rows of 4 numbers."""
        node.matrix = pose

    def get_pose(self, node):
        """Returns a node's pose as it was given."""
        return node.matrix

    def drawn(self):
        """Returns the nodes of visible meshes, in the order of their ids."""
        return [node for node in self.mesh_nodes if node.mesh.is_visible]

    def write(self, width, height, flat=False, both_sides=False, coverage=False):
        """Returns the scene and its main camera as a .glb file. flat: colours without light. coverage: white surfaces without light."""
        to = gltf.Writer()
        for node in self.drawn():
            to.node(node.columns, mesh={"primitives": [part.write(to, flat, both_sides, coverage) for part in node.mesh.primitives]})
        camera = self.main_camera_node
        to.node(camera.columns, camera=camera.camera.write(width, height))
        for node in self.light_nodes if not (flat or coverage) else ():
            to.node(node.columns, light=node.light.entry)
        return to.bytes()
