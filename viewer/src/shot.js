// A picture of the view, as a file.

/** `nostalgin-993-11-2026-11-22.png`: harmless letters only. */
export function nameFor(title, day) {
  const words = title.normalize('NFKD').replace(/[^A-Za-z0-9]+/g, '-').replace(/^-|-$/g, '').slice(0, 60);
  return `${words || 'nostalgin'}-${day}.png`;
}

/** Draws the view anew with whose it is written beneath, and saves it. */
export async function shoot(canvas, draw, title, credit) {
  draw(); // a canvas that was shown already is empty
  const page = document.createElement('canvas');
  const line = Math.max(16, Math.round(canvas.width / 70));
  const foot = 2 * line;
  page.width = canvas.width;
  page.height = canvas.height + foot;
  const context = page.getContext('2d');
  context.fillStyle = '#f3efe5';
  context.fillRect(0, 0, page.width, page.height);
  context.drawImage(canvas, 0, 0);
  context.fillStyle = '#2b2823';
  context.font = `${line}px Garamond, Georgia, serif`;
  context.textBaseline = 'middle';
  context.fillText([title, credit].filter(Boolean).join(' · '), line, canvas.height + foot / 2, page.width - 2 * line);
  const blob = await new Promise((done) => page.toBlob(done, 'image/png'));
  const anchor = document.createElement('a');
  anchor.href = URL.createObjectURL(blob);
  anchor.download = nameFor(title, new Date().toISOString().slice(0, 10));
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 10_000);
  return blob;
}
