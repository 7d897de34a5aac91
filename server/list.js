// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// While trials are being read, ask again each second and put the new table where the old one is.
const kEachMs = 1000;

async function renew() {
  const shown = document.getElementById("trials");
  if (!shown?.hasAttribute("data-reading")) return;
  try {
    const answer = await fetch("./", { cache: "no-store" });
    if (!answer.ok) throw new Error(String(answer.status));
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    const next = page.getElementById("trials");
    if (next) shown.replaceWith(document.adoptNode(next));
    setTimeout(renew, kEachMs);
  } catch {
    shown.querySelector("[role=status]").textContent = "The server has ended; start 'kinemark serve' again.";
  }
}

setTimeout(renew, kEachMs);
