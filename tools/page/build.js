// Bundles the page with its libraries into one file: node build.js OUT.html. The data is put in by
// `definite report`, in place of the last mark.
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const bundle = await build({
  entryPoints: [join(here, "src/main.js")],
  bundle: true,
  format: "esm",
  minify: true,
  write: false,
  legalComments: "none",
});
// A function as the replacement: the text may hold "$&". A script ends at the first "</script".
const put = (text, mark, value) => text.replace(mark, () => value);
let page = readFileSync(join(here, "index.html"), "utf8");
page = put(page, "/*style*/", readFileSync(join(here, "src/style.css"), "utf8"));
page = put(page, "/*script*/", bundle.outputFiles[0].text.replaceAll("</script", "<\\/script"));
writeFileSync(process.argv[2], page);
