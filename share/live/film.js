// SPDX-License-Identifier: GPL-3.0-or-later
// A film of a canvas, as the browser makes it while it is drawn: WebM.
const kinds = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];

export class Film {
  constructor(canvas, button, name) {
    Object.assign(this, { canvas, button, name, recorder: null });
    const known = window.MediaRecorder && canvas.captureStream && kinds.find((kind) => MediaRecorder.isTypeSupported(kind));
    this.kind = known || "";
    button.disabled = !known;
    if (!known)
      button.title = "this browser cannot record";
    button.addEventListener("click", () => (this.recorder ? this.end() : this.begin()));
  }

  begin() {
    const parts = [], recorder = this.recorder = new MediaRecorder(this.canvas.captureStream(), { mimeType: this.kind });
    recorder.addEventListener("dataavailable", (event) => parts.push(event.data));
    recorder.addEventListener("stop", () => this.keep(new Blob(parts, { type: "video/webm" })));
    recorder.start(1000);
    this.show(true);
  }

  // Also when the particles go: what was recorded is kept.
  end() {
    const recorder = this.recorder;
    this.recorder = null;
    if (!recorder)
      return;
    recorder.stop();
    recorder.stream.getTracks().forEach((track) => track.stop());
    this.show(false);
  }

  show(records) {
    this.button.textContent = records ? "Stop recording" : "Record";
    this.button.setAttribute("aria-pressed", records);
  }

  keep(film) {
    if (film.size === 0)
      return;
    const url = URL.createObjectURL(film), link = document.createElement("a");
    link.href = url;
    link.download = this.name() + ".webm";
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }
}
