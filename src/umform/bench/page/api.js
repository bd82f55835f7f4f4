// @ts-check
// Requests to the server of this page, the only ones of the page.

/** An answer with an error. */
export class Refused extends Error {
  /** @param {number} status @param {Record<string, any>} answer */
  constructor(status, answer) {
    super(answer.what ?? `status ${status}`);
    this.status = status;
    this.answer = answer;
  }
}

/** @param {Response} response @returns {Promise<any>} */
async function answered(response) {
  const text = await response.text();
  let answer;
  try {
    answer = JSON.parse(text);
  } catch {
    answer = { what: text };
  }
  if (!response.ok) throw new Refused(response.status, answer);
  return answer;
}

/** @param {string} path @returns {Promise<any>} */
export async function get(path) {
  return answered(await fetch(path));
}

/** @param {string} path @param {object} [content] @param {AbortSignal} [signal] @returns {Promise<any>} */
export async function post(path, content = {}, signal = undefined) {
  const headers = { "content-type": "application/json" };
  return answered(await fetch(path, { method: "POST", headers, body: JSON.stringify(content), signal }));
}
