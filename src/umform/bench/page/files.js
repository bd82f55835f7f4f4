// @ts-check
// Files that are sent to the server.

/** A file as base64. @param {File} file @returns {Promise<string>} */
export function coded(file) {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(String(reader.result).split(",")[1] ?? "");
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(file);
  });
}
