import { readFileSync } from 'node:fs';

import { defineConfig } from 'vite';

const SHIPPED = ['three', '3d-tiles-renderer', 'three-mesh-bvh', '@fontsource/eb-garamond'];

/** Puts the licences of what is bundled beside the bundle. */
const licences = {
  name: 'licences',
  generateBundle() {
    const source = SHIPPED.map((name) => {
      const text = readFileSync(new URL(`node_modules/${name}/LICENSE`, import.meta.url), 'utf8');
      return `${name}\n${'='.repeat(name.length)}\n\n${text.trim()}\n`;
    }).join('\n\n');
    this.emitFile({ type: 'asset', fileName: 'assets/LICENCES.txt', source });
  },
};

// The result is plain files with relative addresses, so that any web server, in any
// folder, will do. The Python wheel carries it as `pipelines/site/viewer_dist`.
export default defineConfig({
  base: './',
  plugins: [licences],
  build: {
    outDir: '../pipelines/site/viewer_dist',
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1200,
    modulePreload: { polyfill: false },
    rolldownOptions: { output: { assetFileNames: 'assets/[name]-[hash][extname]' } },
  },
});
