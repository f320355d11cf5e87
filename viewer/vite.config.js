import { defineConfig } from 'vite';

// The result is plain files with relative addresses, so that any web server, in any
// folder, will do. The Python wheel carries it as `pipelines/viewer_dist`.
export default defineConfig({
  base: './',
  build: {
    outDir: '../pipelines/viewer_dist',
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1200,
    modulePreload: { polyfill: false },
    rolldownOptions: { output: { assetFileNames: 'assets/[name]-[hash][extname]' } },
  },
});
