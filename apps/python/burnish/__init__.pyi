# Made by make_stubs.py from the option tables: edit stub.in and those tables.
"""Types of the package burnish. The package's own text says more."""

import builtins
import os
from collections.abc import Callable, Sequence
from typing import Any, Literal, Protocol

__all__: list[str]

Vector2 = Sequence[float]
Vector3 = Sequence[float]
Vector4 = Sequence[float]
Technique = Literal["auto", "split_isotropic", "bent_normal", "major_axis", "major_axis_adaptive", "major_axis_weighted", "lobe_line", "filtered_is", "filtered_is_ggx", "mc", "as_mc"]
Layer = Literal["depth", "normal", "albedo", "roughness", "tangent", "anisotropy", "metalness", "lod", "object-id", "material-id"]
MipFilter = Literal["box", "lean", "baseline", "covariance", "leadr", "ssgt", "kappa", "mipnet", "teacher"]
Tonemap = Literal["none", "pbr-neutral", "aces"]
Path = str | os.PathLike[str]

class Floats(Protocol):
    """An array: height x width x 3 floats."""

    @property
    def shape(self) -> tuple[int, ...]: ...
    def __iter__(self) -> Any: ...

Progress = Callable[[str, float], object]

class Error(Exception):
    """A failure. `code`: exit code of the program burnish for it."""

    code: int
    def __init__(self, code: int, text: str) -> None: ...

class InputWarning(UserWarning):
    """What was repaired or left out while a scene or an environment was read."""

class Values:
    """Floats by rows, columns and channels, read-only."""

    shape: tuple[int, int, int]
    @property
    def __array_interface__(self) -> dict[str, Any]: ...
    def __dlpack_device__(self) -> tuple[int, int]: ...
    def __dlpack__(
        self,
        *,
        stream: None = None,
        max_version: tuple[int, int] | None = None,
        dl_device: tuple[int, int] | None = None,
        copy: bool | None = None,
    ) -> Any:
        """Returns a DLPack capsule without a copy."""
    def bytes(self) -> memoryview:
        """Returns the floats, flat."""
    def _repr_png_(self) -> builtins.bytes: ...
    def __getitem__(self, at: tuple[int, int]) -> tuple[float, ...]:
        """Returns the channels at (row, column)."""

class Picture:
    """A picture: linear Rec.709 radiance."""

    name: str
    width: int
    height: int
    @property
    def pixels(self) -> Values: ...
    @property
    def variance(self) -> Values | None: ...
    @property
    def hash(self) -> str: ...
    @property
    def __array_interface__(self) -> dict[str, Any]: ...
    def __dlpack_device__(self) -> tuple[int, int]: ...
    def __dlpack__(self, **keywords: Any) -> Any: ...
    def layer(self, name: Layer) -> Values:
        """Returns a layer asked for by render(layers=[...]) or render(aov=[...]). Raises KeyError."""
    def png(self, exposure: float = 0.0, tonemap: Tonemap = "pbr-neutral", progress: Progress | None = None) -> bytes:
        """Returns the bytes of a PNG file. exposure: stops, -64 to 64. progress: See load()."""
    def save(self, path: Path, exposure: float = 0.0, tonemap: Tonemap = "pbr-neutral", progress: Progress | None = None) -> None:
        """Writes .exr .hdr .pfm .png .jpg or .tif. exposure: stops, -64 to 64. Floats have neither exposure nor tone curve.

        progress: See load(). Work that is stopped leaves no file, or the old one.
        """
    def _repr_png_(self) -> bytes: ...
    def _repr_html_(self) -> str: ...

class Scene:
    """A scene under an environment."""

    name: str
    @property
    def nodes(self) -> list[str]:
        """Names by index."""
    @property
    def materials(self) -> list[str]:
        """Names by index."""
    @property
    def variants(self) -> list[str]:
        """Names, for load(path, variant=...)."""
    @property
    def lights(self) -> list[str]:
        """Names by index."""
    def render(
        self,
        progress: Progress | None = None,
        *,
        width: int = 1280,
        height: int = 720,
        msaa: Literal[1, 2, 4, 8, 16] = 8,
        technique: Technique = "auto",
        samples: int | None = None,
        roughness: float | None = None,
        anisotropy: float | None = None,
        background: bool = True,
        texture_anisotropy: int = 16,
        eye: Vector3 | None = None,
        target: Vector3 | None = None,
        orbit: Vector2 | None = None,
        fov: float | None = None,
        zoom: float = 1.0,
        camera: int | str | None = None,
        shadows: Literal["off", "ratio", "on"] = "off",
        shadow_samples: int = 16,
        layers: Sequence[Layer] = (),
        aov: Sequence[Layer] = (),
        resolve: Literal["linear", "display", "weighted"] = "display",
        axis_k: float = 1.0,
        axis_beta: float = 2.3,
        brdf: Literal[
            "ggx_aniso", "ggx", "ellipsoid", "ggx_aniso_separable", "beckmann", "ashikhmin_shirley", "ward", "ward_cheap",
            "heidrich_seidel", "ellipsoid_correlated", "charlie",
        ] = "ggx_aniso",
        diffuse: Literal["lambert", "ashikhmin-shirley"] = "lambert",
        tilt: Vector2 = (0.0, 0.0),
        masking: Literal["correlated", "separable"] = "correlated",
        dfg: Literal["table", "fit"] = "table",
        area_lights: Literal["off", "ltc", "ltc-clipless", "mc", "ltc-isotropic"] = "ltc",
        light_samples: int = 16,
        fresnel: Literal["schlick", "conductor", "dielectric"] = "schlick",
        frame_map: Literal["gram-schmidt", "quaternion", "normal-only", "off"] = "gram-schmidt",
        height_scale: float = 1.0,
        pom_metric: Literal["uv", "surface"] = "surface",
        horizon: Literal["off", "on"] = "on",
        specular_aa: bool = False,
        energy_compensation: bool = False,
        as_tables: Literal["on", "off"] = "on",
        glass: Literal["interface", "body"] = "body",
        seed: int = 0,
    ) -> Picture:
        """Draws a Picture.

        progress: See load().
        width: Pixels.
        height: Pixels.
        msaa: Samples a pixel: 1, 2, 4, 8 or 16.
        technique: Technique for light from the environment.
        samples: Samples of the technique, or samples a pixel of the reference.
        roughness: Overrides the roughness of every material, 0 to 1.
        anisotropy: Overrides the anisotropy of every material, -1 to 1.
        background: Draws the environment behind the scene.
        texture_anisotropy: Texture taps at most, 1 to 16.
        eye: Camera position X,Y,Z, metres.
        target: Point that the camera looks at; without eye it turns the scene's camera, or moves the framed view.
        orbit: View of the whole scene from AZIMUTH,ELEVATION degrees.
        fov: Vertical field of view in degrees; unset: the camera's, else 45.
        zoom: Magnification: shows the scene so many times as large.
        camera: Camera of the scene, by index or name; unset: the first, else the whole scene is shown.
        shadows: Shadows by rays, which scale the lights: off, ratio (of area lights) or on (of lamps and extracted lights too).
        shadow_samples: Samples a pixel for shadows, rounded up to steps of 16.
        layers: Layers of the picture, with commas between: depth, normal, albedo.
        aov: Another name of layers.
        resolve: Mean of a pixel's samples in 8-bit pictures: linear (before tonemapping), display (after tonemapping) or weighted (by 1 /
            (1 + luminance)).
        axis_k: Deviations of slope that the major axis covers, 0.01 to 10.
        axis_beta: Overlap of samples on the major axis, 0 to 100.
        brdf: Reflection model for lights, mc and the reference: ggx_aniso, ggx, ellipsoid, ggx_aniso_separable, beckmann,
            ashikhmin_shirley, ward, ward_cheap, heidrich_seidel, ellipsoid_correlated, charlie.
        diffuse: Diffuse part: lambert (scaled by the light that the lobe lets through) or ashikhmin-shirley (reciprocal, darker at grazing
            angles).
        tilt: Tilt of every lobe against its surface, -80 to 80 degrees: towards the bitangent, and away from the tangent.
        masking: Masking and shadowing of microfacets: correlated (by height) or separable.
        dfg: Directional albedo: table (baked, exact) or fit (analytic, coarse).
        area_lights: Method for light from area lights: off, ltc, ltc-clipless, mc, ltc-isotropic.
        light_samples: Sample points on each area light for area_lights mc. 1 to 65536.
        fresnel: Fresnel reflectance: schlick, dielectric (exact) or conductor (exact for dielectrics and for metals with an index).
        frame_map: Tangents under normal maps: gram-schmidt (projected), quaternion (turned with the normal) or normal-only (unchanged); off
            ignores normal maps.
        height_scale: Factor on the depth of height maps, 0 to 1000; 0 turns parallax off.
        pom_metric: Parallax offset of texture coordinates: surface (as they lie on the surface) or uv (as if they were not stretched).
        horizon: Light from below the surface, towards which a normal map may turn a lobe: blocked (on) or let in (off).
        specular_aa: Widen lobes by the variation of normals between neighbouring pixels.
        energy_compensation: Return the light that rough lobes lose between microfacets.
        as_tables: Half vectors and albedo in as_mc: from tables for the lobe's two widths (on) or computed (off).
        glass: Transmitted light: body (leaves by a second interface, absorbed on its way, and shows opaque surfaces behind) or interface
            (refracted once).
        seed: Seed of random numbers; in as_mc it turns the samples by pixel, except at 0. 0 to 2147483647.
        """
    def reference(
        self,
        samples: int = 1024,
        progress: Progress | None = None,
        *,
        width: int = 1280,
        height: int = 720,
        roughness: float | None = None,
        anisotropy: float | None = None,
        background: bool = True,
        texture_anisotropy: int = 16,
        eye: Vector3 | None = None,
        target: Vector3 | None = None,
        orbit: Vector2 | None = None,
        fov: float | None = None,
        zoom: float = 1.0,
        camera: int | str | None = None,
        reference_mode: Literal["direct", "shadowed", "path"] = "direct",
        bounces: int = 8,
        reference_textures: Literal["footprint", "full"] = "footprint",
        target_error: float | None = None,
        brdf: Literal[
            "ggx_aniso", "ggx", "ellipsoid", "ggx_aniso_separable", "beckmann", "ashikhmin_shirley", "ward", "ward_cheap",
            "heidrich_seidel", "ellipsoid_correlated", "charlie",
        ] = "ggx_aniso",
        diffuse: Literal["lambert", "ashikhmin-shirley"] = "lambert",
        tilt: Vector2 = (0.0, 0.0),
        masking: Literal["correlated", "separable"] = "correlated",
        dfg: Literal["table", "fit"] = "table",
        area_lights: Literal["off", "ltc", "ltc-clipless", "mc", "ltc-isotropic"] = "ltc",
        light_samples: int = 16,
        fresnel: Literal["schlick", "conductor", "dielectric"] = "schlick",
        frame_map: Literal["gram-schmidt", "quaternion", "normal-only", "off"] = "gram-schmidt",
        height_scale: float = 1.0,
        pom_metric: Literal["uv", "surface"] = "surface",
        horizon: Literal["off", "on"] = "on",
        energy_compensation: bool = False,
        seed: int = 0,
    ) -> Picture:
        """Draws a Picture by the Monte Carlo reference.

        samples: Samples a pixel, 1 or more.
        progress: See load().
        width: Pixels.
        height: Pixels.
        roughness: Overrides the roughness of every material, 0 to 1.
        anisotropy: Overrides the anisotropy of every material, -1 to 1.
        background: Draws the environment behind the scene.
        texture_anisotropy: Texture taps at most, 1 to 16.
        eye: Camera position X,Y,Z, metres.
        target: Point that the camera looks at; without eye it turns the scene's camera, or moves the framed view.
        orbit: View of the whole scene from AZIMUTH,ELEVATION degrees.
        fov: Vertical field of view in degrees; unset: the camera's, else 45.
        zoom: Magnification: shows the scene so many times as large.
        camera: Camera of the scene, by index or name; unset: the first, else the whole scene is shown.
        reference_mode: Paths of the reference: direct, shadowed or path.
        bounces: Bounces of the reference in mode path.
        reference_textures: Texture reads of the reference: footprint (filtered over a pixel) or full (at each ray's hit).
        target_error: Relative error at which the reference stops early.
        brdf: Reflection model for lights, mc and the reference: ggx_aniso, ggx, ellipsoid, ggx_aniso_separable, beckmann,
            ashikhmin_shirley, ward, ward_cheap, heidrich_seidel, ellipsoid_correlated, charlie.
        diffuse: Diffuse part: lambert (scaled by the light that the lobe lets through) or ashikhmin-shirley (reciprocal, darker at grazing
            angles).
        tilt: Tilt of every lobe against its surface, -80 to 80 degrees: towards the bitangent, and away from the tangent.
        masking: Masking and shadowing of microfacets: correlated (by height) or separable.
        dfg: Directional albedo: table (baked, exact) or fit (analytic, coarse).
        area_lights: Method for light from area lights: off, ltc, ltc-clipless, mc, ltc-isotropic.
        light_samples: Sample points on each area light for area_lights mc. 1 to 65536.
        fresnel: Fresnel reflectance: schlick, dielectric (exact) or conductor (exact for dielectrics and for metals with an index).
        frame_map: Tangents under normal maps: gram-schmidt (projected), quaternion (turned with the normal) or normal-only (unchanged); off
            ignores normal maps.
        height_scale: Factor on the depth of height maps, 0 to 1000; 0 turns parallax off.
        pom_metric: Parallax offset of texture coordinates: surface (as they lie on the surface) or uv (as if they were not stretched).
        horizon: Light from below the surface, towards which a normal map may turn a lobe: blocked (on) or let in (off).
        energy_compensation: Return the light that rough lobes lose between microfacets.
        seed: Seed of random numbers; in as_mc it turns the samples by pixel, except at 0. 0 to 2147483647.
        """
    def move(self, node: int | str, matrix: Any) -> None:
        """Places a node, by index or name. matrix: to its parent's space, 4 rows of 4 numbers, or 16 column by column."""
    def set_material(
        self,
        material: int | str,
        *,
        base_color: Vector4 | None = None,
        metallic: float | None = None,
        roughness: float | None = None,
        normal_scale: float | None = None,
        occlusion_strength: float | None = None,
        emissive: Vector3 | None = None,
        emissive_strength: float | None = None,
        ior: float | None = None,
        specular: float | None = None,
        specular_color: Vector3 | None = None,
        anisotropy_strength: float | None = None,
        anisotropy_rotation: float | None = None,
        transmission: float | None = None,
        thickness: float | None = None,
        attenuation_distance: float | None = None,
        attenuation_color: Vector3 | None = None,
        dispersion: float | None = None,
        clearcoat: float | None = None,
        clearcoat_roughness: float | None = None,
        clearcoat_normal_scale: float | None = None,
        sheen_color: Vector3 | None = None,
        clearcoat_ior: float | None = None,
        sheen_roughness: float | None = None,
        iridescence: float | None = None,
        iridescence_ior: float | None = None,
        iridescence_thickness_least: float | None = None,
        iridescence_thickness: float | None = None,
        conductor_eta: Vector3 | None = None,
        conductor_k: Vector3 | None = None,
        tilt: Vector2 | None = None,
        tilt_scale: float | None = None,
        height_scale: float | None = None,
        alpha_cutoff: float | None = None,
        double_sided: bool | None = None,
        unlit: bool | None = None,
        lean: bool | None = None,
    ) -> None:
        """Changes factors of a material, by index or name. None: as it is.

        base_color: 0 to 1. glTF: pbrMetallicRoughness/baseColorFactor.
        metallic: 0 to 1. glTF: pbrMetallicRoughness/metallicFactor.
        roughness: 0 to 1. glTF: pbrMetallicRoughness/roughnessFactor. Perceptual, alpha = roughness^2.
        normal_scale: any number. glTF: normalTexture/scale.
        occlusion_strength: 0 to 1. glTF: occlusionTexture/strength.
        emissive: 0 to 1. glTF: emissiveFactor. Cd/m^2 up to exposure, times emissive_strength.
        emissive_strength: 0 or more. glTF: KHR_materials_emissive_strength/emissiveStrength.
        ior: 0 or more. glTF: KHR_materials_ior/ior.
        specular: 0 to 1. glTF: KHR_materials_specular/specularFactor.
        specular_color: 0 or more. glTF: KHR_materials_specular/specularColorFactor.
        anisotropy_strength: 0 to 1. glTF: KHR_materials_anisotropy/anisotropyStrength.
        anisotropy_rotation: any number. glTF: KHR_materials_anisotropy/anisotropyRotation. Radians, counter-clockwise from the tangent.
        transmission: 0 to 1. glTF: KHR_materials_transmission/transmissionFactor. Transmitted share of the light that is not reflected,
            times base_color.
        thickness: 0 or more. glTF: KHR_materials_volume/thicknessFactor. Of the body below the surface, metres in the mesh's own space; 0:
            the mesh tells. Bodies are closed meshes; open ones are thin.
        attenuation_distance: 0 or more. glTF: KHR_materials_volume/attenuationDistance.
        attenuation_color: 0 to 1. glTF: KHR_materials_volume/attenuationColor. The light's share left after attenuation_distance (metres,
            world space; 0: infinite) inside a body.
        dispersion: 0 or more. glTF: KHR_materials_dispersion/dispersion. 20 over the Abbe number: red, green and blue have indices ior - h,
            ior, ior + h, h = (ior - 1) dispersion / 40.
        clearcoat: 0 to 1. glTF: KHR_materials_clearcoat/clearcoatFactor. Share of the surface under a clear coat with index clearcoat_ior.
        clearcoat_roughness: 0 to 1. glTF: KHR_materials_clearcoat/clearcoatRoughnessFactor. Perceptual, of the coat alone.
        clearcoat_normal_scale: any number. glTF: KHR_materials_clearcoat/clearcoatNormalTexture/scale.
        sheen_color: 0 to 1. glTF: KHR_materials_sheen/sheenColorFactor. Colour of a layer of fibres, which reflects this times its lobe's
            albedo; black: none.
        clearcoat_ior: 1 to 1000. glTF: extras/burnish/clearcoat/ior.
        sheen_roughness: 0 to 1. glTF: KHR_materials_sheen/sheenRoughnessFactor. Perceptual, of the fibres alone.
        iridescence: 0 to 1. glTF: KHR_materials_iridescence/iridescenceFactor. Share of the surface under a thin film with index
            iridescence_ior.
        iridescence_ior: 1 or more. glTF: KHR_materials_iridescence/iridescenceIor.
        iridescence_thickness_least: 0 or more. glTF: KHR_materials_iridescence/iridescenceThicknessMinimum.
        iridescence_thickness: 0 or more. glTF: KHR_materials_iridescence/iridescenceThicknessMaximum. Of the film, nm; where a texture is
            0, iridescence_thickness_least.
        conductor_eta: 0 to 10000. glTF: extras/burnish/conductor/eta. A metal's index eta + i k for red, green and blue; both 0: none.
        conductor_k: 0 to 10000. glTF: extras/burnish/conductor/k. A metal's index eta + i k for red, green and blue; both 0: none.
        tilt: -80 to 80. glTF: extras/burnish/tilt. Degrees between lobe and surface, towards the bitangent and away from the tangent.
        tilt_scale: any number. glTF: extras/burnish/tiltTexture/scale. Multiplies the slopes in the tilt texture.
        height_scale: 0 to 1000. glTF: extras/burnish/heightTexture/scale. Depth of height 0 below height 1, in lengths of texture
            coordinates. One such length is the square root of the area under a unit square of coordinates.
        alpha_cutoff: 0 or more. glTF: alphaCutoff.
        double_sided: glTF: doubleSided.
        unlit: glTF: KHR_materials_unlit.
        lean: glTF: extras/burnish/lean.
        """
    def set_primitive_material(self, primitive: int, material: int | str) -> None:
        """Gives a primitive another material, by index or name. Primitive i of meshes() is mesh i."""
    def set_light(
        self,
        light: int | str,
        *,
        color: Vector3 | None = None,
        intensity: float | None = None,
        range: float | None = None,
        inner_cone: float | None = None,
        outer_cone: float | None = None,
    ) -> None:
        """Changes factors of a point, spot or directional light, by index or name. None: as it is.

        color: glTF: color.
        intensity: glTF: intensity. candela, or lux of directional lights.
        range: glTF: range. metres.
        inner_cone: glTF: spot/innerConeAngle. radians.
        outer_cone: glTF: spot/outerConeAngle. radians.
        """
    def set_environment(
        self,
        environment: Path | Picture | Values | Floats | None = None,
        progress: Progress | None = None,
        *,
        env_size: Literal[16, 32, 64, 128, 256, 512, 1024, 2048] = 512,
        env_samples: int = 1024,
        env_rotation: float = 0.0,
        env_exposure: float = 0.0,
        key_lights: int | Literal["auto", "off"] = "auto",
        cache: bool = True,
    ) -> None:
        """Lights the pictures to come by another environment. Arguments: see load()."""
    def _repr_png_(self) -> bytes: ...
    def _repr_html_(self) -> str: ...

class Mesh:
    """Triangles with a material, for meshes()."""

    vertices: int
    def __init__(
        self,
        positions: Any,
        triangles: Any = None,
        normals: Any = None,
        coordinates: Any = None,
        transform: Any = None,
        *,
        base_color: Vector4 = (1.0, 1.0, 1.0, 1.0),
        metallic: float = 0.0,
        roughness: float = 1.0,
        normal_scale: float = 1.0,
        occlusion_strength: float = 1.0,
        emissive: Vector3 = (0.0, 0.0, 0.0),
        emissive_strength: float = 1.0,
        ior: float = 1.5,
        specular: float = 1.0,
        specular_color: Vector3 = (1.0, 1.0, 1.0),
        anisotropy_strength: float = 0.0,
        anisotropy_rotation: float = 0.0,
        transmission: float = 0.0,
        thickness: float = 0.0,
        attenuation_distance: float = 0.0,
        attenuation_color: Vector3 = (1.0, 1.0, 1.0),
        dispersion: float = 0.0,
        clearcoat: float = 0.0,
        clearcoat_roughness: float = 0.0,
        clearcoat_normal_scale: float = 1.0,
        sheen_color: Vector3 = (0.0, 0.0, 0.0),
        clearcoat_ior: float = 1.5,
        sheen_roughness: float = 0.0,
        iridescence: float = 0.0,
        iridescence_ior: float = 1.3,
        iridescence_thickness_least: float = 100.0,
        iridescence_thickness: float = 400.0,
        conductor_eta: Vector3 = (0.0, 0.0, 0.0),
        conductor_k: Vector3 = (0.0, 0.0, 0.0),
        tilt: Vector2 = (0.0, 0.0),
        tilt_scale: float = 1.0,
        height_scale: float = 0.05,
        alpha_cutoff: float = 0.5,
        double_sided: bool = False,
        unlit: bool = False,
        lean: bool = False,
    ) -> None:
        """Makes a mesh.

        positions, normals: 3 floats a vertex. coordinates: 2 floats a vertex, (0, 0) is the upper left.
        triangles: 3 vertices each, counter-clockwise from the front. transform: 4 rows of 4 numbers, or 16 column by column.
        base_color: 0 to 1. glTF: pbrMetallicRoughness/baseColorFactor.
        metallic: 0 to 1. glTF: pbrMetallicRoughness/metallicFactor.
        roughness: 0 to 1. glTF: pbrMetallicRoughness/roughnessFactor. Perceptual, alpha = roughness^2.
        normal_scale: any number. glTF: normalTexture/scale.
        occlusion_strength: 0 to 1. glTF: occlusionTexture/strength.
        emissive: 0 to 1. glTF: emissiveFactor. Cd/m^2 up to exposure, times emissive_strength.
        emissive_strength: 0 or more. glTF: KHR_materials_emissive_strength/emissiveStrength.
        ior: 0 or more. glTF: KHR_materials_ior/ior.
        specular: 0 to 1. glTF: KHR_materials_specular/specularFactor.
        specular_color: 0 or more. glTF: KHR_materials_specular/specularColorFactor.
        anisotropy_strength: 0 to 1. glTF: KHR_materials_anisotropy/anisotropyStrength.
        anisotropy_rotation: any number. glTF: KHR_materials_anisotropy/anisotropyRotation. Radians, counter-clockwise from the tangent.
        transmission: 0 to 1. glTF: KHR_materials_transmission/transmissionFactor. Transmitted share of the light that is not reflected,
            times base_color.
        thickness: 0 or more. glTF: KHR_materials_volume/thicknessFactor. Of the body below the surface, metres in the mesh's own space; 0:
            the mesh tells. Bodies are closed meshes; open ones are thin.
        attenuation_distance: 0 or more. glTF: KHR_materials_volume/attenuationDistance.
        attenuation_color: 0 to 1. glTF: KHR_materials_volume/attenuationColor. The light's share left after attenuation_distance (metres,
            world space; 0: infinite) inside a body.
        dispersion: 0 or more. glTF: KHR_materials_dispersion/dispersion. 20 over the Abbe number: red, green and blue have indices ior - h,
            ior, ior + h, h = (ior - 1) dispersion / 40.
        clearcoat: 0 to 1. glTF: KHR_materials_clearcoat/clearcoatFactor. Share of the surface under a clear coat with index clearcoat_ior.
        clearcoat_roughness: 0 to 1. glTF: KHR_materials_clearcoat/clearcoatRoughnessFactor. Perceptual, of the coat alone.
        clearcoat_normal_scale: any number. glTF: KHR_materials_clearcoat/clearcoatNormalTexture/scale.
        sheen_color: 0 to 1. glTF: KHR_materials_sheen/sheenColorFactor. Colour of a layer of fibres, which reflects this times its lobe's
            albedo; black: none.
        clearcoat_ior: 1 to 1000. glTF: extras/burnish/clearcoat/ior.
        sheen_roughness: 0 to 1. glTF: KHR_materials_sheen/sheenRoughnessFactor. Perceptual, of the fibres alone.
        iridescence: 0 to 1. glTF: KHR_materials_iridescence/iridescenceFactor. Share of the surface under a thin film with index
            iridescence_ior.
        iridescence_ior: 1 or more. glTF: KHR_materials_iridescence/iridescenceIor.
        iridescence_thickness_least: 0 or more. glTF: KHR_materials_iridescence/iridescenceThicknessMinimum.
        iridescence_thickness: 0 or more. glTF: KHR_materials_iridescence/iridescenceThicknessMaximum. Of the film, nm; where a texture is
            0, iridescence_thickness_least.
        conductor_eta: 0 to 10000. glTF: extras/burnish/conductor/eta. A metal's index eta + i k for red, green and blue; both 0: none.
        conductor_k: 0 to 10000. glTF: extras/burnish/conductor/k. A metal's index eta + i k for red, green and blue; both 0: none.
        tilt: -80 to 80. glTF: extras/burnish/tilt. Degrees between lobe and surface, towards the bitangent and away from the tangent.
        tilt_scale: any number. glTF: extras/burnish/tiltTexture/scale. Multiplies the slopes in the tilt texture.
        height_scale: 0 to 1000. glTF: extras/burnish/heightTexture/scale. Depth of height 0 below height 1, in lengths of texture
            coordinates. One such length is the square root of the area under a unit square of coordinates.
        alpha_cutoff: 0 or more. glTF: alphaCutoff.
        double_sided: glTF: doubleSided.
        unlit: glTF: KHR_materials_unlit.
        lean: glTF: extras/burnish/lean.
        """

class Comparison:
    """Figures of two pictures. FLIP lies in [0, 1]."""

    pictures: tuple[Any, Any]
    flip_mean: float
    flip_p99: float
    flip_max: float
    mse: float
    rel_mse: float
    max_abs: float
    differing_fraction: float
    def _repr_html_(self) -> str: ...

def version() -> str:
    """Returns the library's version."""

def techniques() -> dict[str, str]:
    """Returns the techniques: {name: summary}."""

def options() -> dict[str, str]:
    """Returns the keywords: {name: meaning}."""

def load(
    path: Path,
    environment: Path | Picture | Values | Floats | None = None,
    progress: Progress | None = None,
    *,
    threads: int = 0,
    floor: Literal["off", "shadow", "stage", "mirror"] = "off",
    light: str | Sequence[str] = (),
    time: float | None = None,
    animation: int = 0,
    variant: str | None = None,
    f0: Vector3 | None = None,
    mip_filter: MipFilter = "box",
    mip_kappa: float = 0.7,
    mip_gain: Literal["off", "on"] = "off",
    fallback: Literal["auto", "off"] = "auto",
    couple: Literal["none", "albedo"] = "none",
    color_kernel: Literal["box", "kaiser"] = "box",
    env_size: Literal[16, 32, 64, 128, 256, 512, 1024, 2048] = 512,
    env_samples: int = 1024,
    env_rotation: float = 0.0,
    env_exposure: float = 0.0,
    key_lights: int | Literal["auto", "off"] = "auto",
    cache: bool = True,
) -> Scene:
    """Opens a scene: a .gltf, .glb or .obj file, or "builtin:NAME".

    environment: A path, "builtin:NAME", or an equirectangular picture of height x width x 3 floats, linear Rec.709 radiance.
        None: the scene's own light, else builtin:studio.
    progress: Called with the work's name and the share of its current step that is done, -1 where unknown, about ten times a
        second. A true result stops the work, as Ctrl-C does. Raises KeyboardInterrupt then.
    threads: Worker threads; 0: all cores.
    floor: Floor below the scene: off, shadow, stage or mirror.
    light: Area lights in the words that the program takes, several with ';' between.
    time: Time in the scene's animation, seconds; unset: the scene at rest.
    animation: Animation that time refers to, by index.
    variant: Variant of the scene's materials, by name; unset: the meshes' own materials.
    f0: Reflectance at normal incidence of all materials.
    mip_filter: Filter for distant normal and roughness maps.
    mip_kappa: Share of the normals' covariance that widens lobes, for the kappa filter and taps under mipnet and teacher.
    mip_gain: Scales each level's colours to reflect as much lamp light as the finest level, under ssgt, kappa, mipnet and teacher.
    fallback: Closed forms where the net of the mipnet filter is worse: auto or off.
    couple: Weights of base colours and metalness in mip levels: none, or albedo (texels that face light and eye weigh more).
    color_kernel: Averaging kernel for base colours and metalness in mip levels.
    env_size: Texels along an edge of the environment's cube map.
    env_samples: Samples a texel of the prefiltered environment.
    env_rotation: Rotation of the environment in degrees.
    env_exposure: Exposure of the environment in stops.
    key_lights: Small strong lights to extract from the environment and shade one by one, at most.
    cache: Keeps bakes in the cache.
    """

def meshes(
    *parts: Mesh,
    environment: Path | Picture | Values | Floats | None = None,
    progress: Progress | None = None,
    threads: int = 0,
    light: str | Sequence[str] = (),
    env_size: Literal[16, 32, 64, 128, 256, 512, 1024, 2048] = 512,
    env_samples: int = 1024,
    env_rotation: float = 0.0,
    env_exposure: float = 0.0,
    key_lights: int | Literal["auto", "off"] = "auto",
    cache: bool = True,
) -> Scene:
    """Makes a scene of meshes, one at least. environment and progress: see load().

    threads: Worker threads; 0: all cores.
    light: Area lights in the words that the program takes, several with ';' between.
    env_size: Texels along an edge of the environment's cube map.
    env_samples: Samples a texel of the prefiltered environment.
    env_rotation: Rotation of the environment in degrees.
    env_exposure: Exposure of the environment in stops.
    key_lights: Small strong lights to extract from the environment and shade one by one, at most.
    cache: Keeps bakes in the cache.
    """

def compare(reference: Picture | Values | Floats, test: Picture | Values | Floats, progress: Progress | None = None) -> Comparison:
    """Compares two pictures of height x width x 3 floats."""
