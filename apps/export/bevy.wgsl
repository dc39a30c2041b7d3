// @TECHNIQUE@ for Bevy 0.15: environment light of an extension of StandardMaterial. From burnish @VERSION@ (Apache License 2.0).
//
// Declare the extension with these bindings, and let fragment_shader() return this file:
//
//     #[derive(Asset, AsBindGroup, Reflect, Debug, Clone)]
//     struct Burnish {
//         #[uniform(100)] lobe: Vec4,   // strength and rotation as KHR_materials_anisotropy has them, levels of the cube, scale of the light
//         #[texture(101, dimension = "cube")] #[sampler(102)] specular: Handle<Image>,
//         #[texture(103, dimension = "cube")] irradiance: Handle<Image>,
//         #[texture(104)] lobe_albedo: Handle<Image>,
//     }
//
// The images are specular.ktx2, irradiance.ktx2 and lobe_albedo.ktx2 of `burnish bake environment PICTURE --format ktx2`. Leave
// EnvironmentMapLight away, and set AmbientLight to 0: this file has the light of the environment. Lamps, emission and exposure stay Bevy's.
// The lobe is glTF's, without light that leaves it after several bounces.
// Meshes need tangents: without these the grain has no direction. Unlit materials are none for this file.
#import bevy_pbr::{
    forward_io::{FragmentOutput, VertexOutput},
    mesh_view_bindings::view,
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{alpha_discard, apply_pbr_lighting, main_pass_post_lighting_processing},
}

@group(2) @binding(100) var<uniform> burnish_lobe: vec4<f32>;
@group(2) @binding(101) var burnish_specular: texture_cube<f32>;
@group(2) @binding(102) var burnish_sampler: sampler;
@group(2) @binding(103) var burnish_irradiance: texture_cube<f32>;
@group(2) @binding(104) var burnish_lobe_albedo: texture_2d<f32>;

@SHADER@
fn burnish_radiance(cube: i32, direction: vec3<f32>, lod: f32) -> vec4<f32> {
    return textureSampleLevel(burnish_specular, burnish_sampler, direction, lod) * burnish_lobe.w;
}

fn burnish_albedo_at(at: vec2<f32>) -> vec2<f32> {
    return textureSampleLevel(burnish_lobe_albedo, burnish_sampler, at, 0.0).rg;
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    // Let Bevy light by lamps
    var input = pbr_input_from_standard_material(in, is_front);
    input.material.base_color = alpha_discard(input.material, input.material.base_color);
    var out: FragmentOutput;
    out.color = apply_pbr_lighting(input);
    // Find the lobe's widths and grain
    let n = normalize(input.N);
    let v = normalize(input.V);
    let alpha = max(input.material.perceptual_roughness * input.material.perceptual_roughness, 1e-3);
    let along = mix(alpha, 1.0, burnish_lobe.x * burnish_lobe.x);
    let mean = 0.5 * (along + alpha);
    let roughness = sqrt(mean);
    let anisotropy = (along - alpha) / (2.0 * mean);
#ifdef VERTEX_TANGENTS
    let given = in.world_tangent;
#else
    let given = vec4<f32>(select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(n.x) < 0.5), 1.0);
#endif
    let tangent = normalize(given.xyz - n * dot(n, given.xyz));
    let bitangent = cross(n, tangent) * given.w;
    let grain = tangent * cos(burnish_lobe.y) + bitangent * sin(burnish_lobe.y);
    // Fetch the lobe's albedo
    let at = burnish_albedo_place(n, v, grain, roughness, anisotropy);
    let upper = mix(burnish_albedo_at(at.xy), burnish_albedo_at(at.xy + vec2<f32>(0.1, 0.0)), at.z);
    let lower = mix(burnish_albedo_at(at.xy + vec2<f32>(0.0, 0.1)), burnish_albedo_at(at.xy + vec2<f32>(0.1, 0.1)), at.z);
    let dfg = mix(upper, lower, at.w);
    // Add the environment's light
    let base = input.material.base_color.rgb;
    let dielectric = 0.16 * input.material.reflectance * input.material.reflectance;
    let f0 = mix(vec3<f32>(dielectric), base, input.material.metallic);
    let f = burnish_usual_settings(i32(textureDimensions(burnish_specular).x), i32(burnish_lobe.z), @SAMPLES@);
    let x = burnish_point_of(f, n, v, grain, f0, vec3<f32>(1.0), roughness, anisotropy, dfg, 0);
    let specular = burnish_@TECHNIQUE@_specular(f, x);
    let irradiance = textureSampleLevel(burnish_irradiance, burnish_sampler, n, 0.0).rgb * burnish_lobe.w;
    let diffuse = base * (1.0 - input.material.metallic) * (1.0 - dielectric * dfg.x - dfg.y) * irradiance;
    out.color = vec4<f32>(out.color.rgb + (specular + diffuse) * input.diffuse_occlusion * view.exposure, out.color.a);
    out.color = main_pass_post_lighting_processing(input, out.color);
    return out;
}
