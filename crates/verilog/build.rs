//! Embeds the templates of `templates/board`, so that boards and families name them as data.

fn main() {
    minijinja_embed::embed_templates!("templates/board");
}
