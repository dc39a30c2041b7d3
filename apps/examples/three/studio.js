// A studio as an equirectangular picture: a dim room with soft boxes.

export const width = 512, height = 256;
const boxes = [[-1.9, 0.55, 0.5, 0.35, 4], [0.4, 0.8, 0.35, 0.25, 3], [1.5, 0.3, 0.08, 0.6, 6], [2.7, 0.6, 0.4, 0.1, 2.5]]; // azimuth, height, half sizes (radians), radiance

// Returns radiance, four floats a pixel, from the lowest row on.
export function studio() {
  const out = new Float32Array(4 * width * height);
  for (let row = 0; row < height; ++row)
    for (let column = 0; column < width; ++column) {
      const azimuth = (column + 0.5) / width * 2 * Math.PI - Math.PI, up = (row + 0.5) / height * Math.PI - Math.PI / 2;
      let light = 0.12 + 0.25 * Math.max(Math.sin(up), 0);
      for (const [around, above, wide, high, radiance] of boxes)
        if (Math.abs(azimuth - around) < wide && Math.abs(up - above) < high)
          light = radiance;
      out.set([light, light, light, 1], 4 * (row * width + column));
    }
  return out;
}
