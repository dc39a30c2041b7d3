"""A scene of meshes, lights and cameras, each with a pose."""

import math

from . import gltf
from .checks import check_rotation, colour, matrix, numbers, refuse, refuse_given
from .meshes import Boxed, Mesh, corners_of
from .views import CAMERAS, DirectionalLight, Light, PointLight, SpotLight

try:
    import numpy
except ImportError:
    numpy = None

IDENTITY = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))


def product(a, b):
    """Returns the product of two matrices of 16 floats, column by column. IDENTITY leaves the other's bits."""
    return [sum(a[4 * k + row] * b[4 * column + k] for k in range(4)) for column in range(4) for row in range(4)]


def rows_of(columns):
    """Returns 4 rows of 4 numbers, as a numpy array where numpy is there."""
    rows = tuple(tuple(columns[4 * column + row] for column in range(4)) for row in range(4))
    return rows if numpy is None else numpy.array(rows)


def _vector(values, name, count):
    flat = numbers(values, name)
    if len(flat) != count:
        refuse(name, f"{len(flat)} numbers are not {count}")
    return flat


def _composed(translation, rotation, scale):
    """Returns 4 rows: scaled, then turned by a quaternion (x, y, z, w), then moved."""
    x, y, z, w = rotation
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if length < 1e-12:
        refuse("rotation", "a quaternion of length 0 is no rotation")
    x, y, z, w = x / length, y / length, z / length, w / length
    turn = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)), (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    return tuple(tuple(turn[row][k] * scale[k] for k in range(3)) + (translation[row],) for row in range(3)) + (IDENTITY[3],)


def _quaternion(axes):
    """Returns (x, y, z, w) of a rotation by its three columns."""
    (a, b, c), (d, e, f), (g, h, i) = axes
    squares = ((1 + a - e - i), (1 - a + e - i), (1 - a - e + i), (1 + a + e + i))  # 4 x^2, 4 y^2, 4 z^2, 4 w^2
    most = max(range(4), key=squares.__getitem__)
    products = {0: (squares[0], b + d, c + g, f - h), 1: (b + d, squares[1], f + h, g - c), 2: (c + g, f + h, squares[2], b - d),
                3: (f - h, g - c, b - d, squares[3])}[most]
    scale = 0.5 / math.sqrt(squares[most])
    return [value * scale for value in products]


class Node:
    """A place in a scene, with a mesh, a camera or a light, or none. children: Nodes that move with it. matrix: its pose in its parent's space,
    4 rows of 4 numbers; or translation (x, y, z), rotation (quaternion x, y, z, w) and scale (x, y, z, or one number)."""

    def __init__(self, name=None, camera=None, children=None, skin=None, mesh=None, light=None, matrix=None, rotation=None, scale=None,
                 translation=None, weights=None):
        refuse_given(skin=skin, weights=weights)
        self.name, self.camera, self.mesh, self.light, self.children = name, camera, mesh, light, list(children or ())
        if matrix is not None and (rotation is not None or scale is not None or translation is not None):
            refuse("matrix", "cannot be combined with translation, rotation and scale")
        self._given = None  # translation, rotation and scale, once one of them was set
        self.matrix = IDENTITY if matrix is None else matrix
        for part, value in (("scale", scale), ("rotation", rotation), ("translation", translation)):
            if value is not None:
                setattr(self, part, value)

    @property
    def matrix(self):
        return self._matrix

    @matrix.setter
    def matrix(self, pose):
        self._pose(pose)
        self._given = None

    def _pose(self, pose):
        columns = matrix(pose, "pose")
        if self.camera is not None or self.light is not None:
            check_rotation(columns, "pose")
        self._matrix, self.columns = pose, columns

    def _parts(self):
        """Returns translation, rotation and scale: as they were set, else from the matrix. A mirroring matrix has a negative x scale. Shears
        are left out."""
        if self._given:
            return self._given
        axes = [self.columns[4 * i : 4 * i + 3] for i in range(3)]
        scale = [math.sqrt(sum(value * value for value in axis)) for axis in axes]
        (a, b, c), (d, e, f), (g, h, i) = axes
        if a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0:
            scale[0] = -scale[0]
        if 0 in scale:
            return self.columns[12:15], [0.0, 0.0, 0.0, 1.0], scale
        return self.columns[12:15], _quaternion([[value / size for value in axis] for axis, size in zip(axes, scale)]), scale

    def _set_parts(self, translation, rotation, scale):
        self._pose(_composed(translation, rotation, scale))
        size = math.sqrt(sum(value * value for value in rotation))
        self._given = translation, [value / size for value in rotation], scale

    @property
    def translation(self):
        return self._parts()[0]

    @translation.setter
    def translation(self, value):
        self._set_parts(_vector(value, "translation", 3), *self._parts()[1:])

    @property
    def rotation(self):
        return self._parts()[1]

    @rotation.setter
    def rotation(self, value):
        translation, _, scale = self._parts()
        self._set_parts(translation, _vector(value, "rotation", 4), scale)

    @property
    def scale(self):
        return self._parts()[2]

    @scale.setter
    def scale(self, value):
        translation, rotation, _ = self._parts()
        self._set_parts(translation, rotation, _vector(value if hasattr(value, "__iter__") else [value] * 3, "scale", 3))


class Scene(Boxed):
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
        self.roots, self.main_camera_node = [], None
        for node in nodes or ():
            self.add_node(node)

    bg_color = property(lambda self: self._bg, lambda self, value: setattr(self, "_bg", None if value is None else colour(value, "bg_color", 1)))
    ambient_light = property(lambda self: self._ambient, lambda self, value: setattr(self, "_ambient", colour(value, "ambient_light")[:3]))
    nodes = property(lambda self: [node for node, _, _ in self._walk()])
    mesh_nodes = property(lambda self: [node for node in self.nodes if node.mesh is not None])
    camera_nodes = property(lambda self: [node for node in self.nodes if node.camera is not None])
    light_nodes = property(lambda self: [node for node in self.nodes if node.light is not None])
    meshes = property(lambda self: {node.mesh for node in self.mesh_nodes})
    cameras = property(lambda self: {node.camera for node in self.camera_nodes})
    lights = property(lambda self: {node.light for node in self.light_nodes})
    directional_light_nodes = property(lambda self: self._lit_by(DirectionalLight))
    point_light_nodes = property(lambda self: self._lit_by(PointLight))
    spot_light_nodes = property(lambda self: self._lit_by(SpotLight))
    directional_lights = property(lambda self: {node.light for node in self.directional_light_nodes})
    point_lights = property(lambda self: {node.light for node in self.point_light_nodes})
    spot_lights = property(lambda self: {node.light for node in self.spot_light_nodes})

    @classmethod
    def from_trimesh_scene(cls, trimesh_scene, bg_color=None, ambient_light=None):
        """Returns a Scene of an object like trimesh's Scene: its meshes at their places."""
        scene = cls(bg_color=bg_color, ambient_light=ambient_light)
        meshes = {name: Mesh.from_trimesh(part) for name, part in trimesh_scene.geometry.items()}
        for node in trimesh_scene.graph.nodes_geometry:
            pose, name = trimesh_scene.graph[node]
            scene.add(meshes[name], pose=pose)
        return scene

    def _lit_by(self, kind):
        return [node for node in self.light_nodes if isinstance(node.light, kind)]

    def _walk(self):
        """Returns (node, pose to world space column by column, parent or None) of each node, parents before their children."""
        found, seen, left = [], set(), [(node, None, None) for node in reversed(self.roots)]
        while left:
            node, above, parent = left.pop()
            if id(node) in seen:
                refuse("children", "a node has two parents")
            seen.add(id(node))
            pose = node.columns if above is None else product(above, node.columns)
            found.append((node, pose, parent))
            left += [(child, pose, node) for child in reversed(node.children)]
        return found

    def _placed(self, node):
        """Returns (pose to world space, parent) of a node. Refuses a node that the scene does not have."""
        for other, pose, parent in self._walk():
            if other is node:
                return pose, parent
        refuse("node", "the scene does not have it")

    def add(self, obj, name=None, pose=None, parent_node=None, parent_name=None):
        """Adds a Mesh, a camera or a light. pose: 4 rows of 4 numbers, to the parent's space; None: the identity. Returns its Node."""
        kind = "mesh" if isinstance(obj, Mesh) else "light" if isinstance(obj, Light) else "camera" if isinstance(obj, CAMERAS) else None
        if kind is None:
            refuse("obj", f"a {type(obj).__name__} is no mesh, camera or light")
        if parent_node is None and parent_name is not None:
            named = self.get_nodes(name=parent_name)
            if len(named) != 1:
                refuse("parent_name", f"{len(named)} nodes have the name {parent_name!r}")
            (parent_node,) = named
        return self.add_node(Node(name, matrix=pose, **{kind: obj}), parent_node)

    def add_node(self, node, parent_node=None):
        """Adds a Node with its children, at the root or to a node of the scene. The first camera is the main one. Returns the node."""
        if parent_node is None:
            self.roots.append(node)
        elif self.has_node(parent_node):
            parent_node.children.append(node)
        else:
            refuse("parent_node", "the scene does not have it")
        try:
            cameras = self.camera_nodes
        except Exception:
            (self.roots if parent_node is None else parent_node.children).pop()
            raise
        if self.main_camera_node is None:
            self.main_camera_node = next(iter(cameras), None)
        return node

    def has_node(self, node):
        return any(node is other for other in self.nodes)

    def get_nodes(self, node=None, obj=None, name=None, obj_name=None):
        """Returns the set of nodes that match every argument: the node itself, its mesh, camera or light, its name, its thing's name."""
        things = lambda at: [thing for thing in (at.mesh, at.camera, at.light) if thing is not None]
        return {at for at in self.nodes if (node is None or at is node) and (name is None or at.name == name)
                and (obj is None or any(thing is obj for thing in things(at)))
                and (obj_name is None or any(getattr(thing, "name", None) == obj_name for thing in things(at)))}

    def remove_node(self, node):
        """Removes a node with its children. Raises burnish.Error where the scene lacks it."""
        _, parent = self._placed(node)
        if parent is None:
            self.roots = [other for other in self.roots if other is not node]
        else:
            parent.children = [other for other in parent.children if other is not node]
        if self.main_camera_node is not None and not self.has_node(self.main_camera_node):
            self.main_camera_node = next(iter(self.camera_nodes), None)

    def clear(self):
        """Removes all nodes."""
        self.roots, self.main_camera_node = [], None

    def set_pose(self, node, pose):
        """Moves a node. pose: 4 rows of 4 numbers, to its parent's space."""
        node.matrix = pose

    def get_pose(self, node):
        """Returns a node's pose to world space: as it was given where it has no parent."""
        pose, parent = self._placed(node)
        return node.matrix if parent is None else rows_of(pose)

    @property
    def bounds(self):
        """((x, y, z), (x, y, z)): the least and the largest corner of the boxes around the meshes, in world space. Zeros without meshes."""
        corners = [[sum(pose[4 * k + row] * value for k, value in enumerate((*corner, 1.0))) for row in range(3)]
                   for node, pose, _ in self._walk() if node.mesh is not None for corner in corners_of(node.mesh.bounds)]
        box = tuple(tuple(of(corner[i] for corner in corners) if corners else 0.0 for i in range(3)) for of in (min, max))
        return box if numpy is None else numpy.array(box)

    def drawn(self):
        """Returns the nodes of visible meshes, in the order of their ids."""
        return [node for node in self.mesh_nodes if node.mesh.is_visible]

    def write(self, width, height, flat=False, both_sides=False, coverage=False):
        """Returns the scene and its main camera as a .glb file. flat: colours without light. coverage: white surfaces without light."""
        to, placed = gltf.Writer(), self._walk()
        for node, pose, _ in placed:
            if node.mesh is not None and node.mesh.is_visible:
                to.node(pose, mesh={"primitives": [part.write(to, flat, both_sides, coverage) for part in node.mesh.primitives]})
        pose, _ = self._placed(self.main_camera_node)
        check_rotation(pose, "pose")
        to.node(pose, camera=self.main_camera_node.camera.write(width, height))
        for node, pose, _ in placed if not (flat or coverage) else ():
            if node.light is not None:
                check_rotation(pose, "pose")
                to.node(pose, light=node.light.entry())
        return to.bytes()
